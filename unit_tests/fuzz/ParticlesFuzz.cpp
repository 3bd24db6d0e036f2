#include "framework/files/CsvTable.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/sph/Particles.hpp"
#include "unit_tests/fuzz/Harness.hpp"

// Particle files: the first byte says whether the others are CSV, HDF5, or a table of numbers.

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  kiln::fuzz::initialise();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kiln;
  if (size == 0) return -1;
  const char* const names[] = {"cloud.csv", "cloud.h5", "table.csv"};
  const int kind = data[0] % 3;
  const std::string file = fuzz::scratch(names[kind]);
  fuzz::write(file, data + 1, size - 1);
  fuzz::refuses_or_does([&] {
    if (kind == 2) {
      read_csv(file);
      return;
    }
    Teuchos::ParameterList list("model.particles");
    list.set("type", std::string("file"));
    list.set("path", file);
    list.set("spacing", 1e-4);
    list.set("volume", 1e-9);
    const ParticleCloud cloud = Registry<Particles>::create(list, {fuzz::alone()})->cloud();
    if (cloud.volumes.size() != cloud.positions.size() || cloud.heated_areas.size() != cloud.positions.size()) {
      fuzz::found("a cloud whose parts are of different lengths");
    }
  });
  return 0;
}
