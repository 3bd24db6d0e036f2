#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "framework/files/CsvColumns.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {
namespace {

/// Columns of a particle file, whatever its format. `place` names a row in errors.
struct Columns {
  std::vector<double> x, y, z, volume, area;
  std::function<std::string(std::size_t)> place;
};

/// Particles in any arrangement, from columns x, y, z and, as wanted, volume and area: a CSV file with a header line,
/// or HDF5 datasets of these names. A particle's id is its row.
class ParticleFile final : public Particles {
 public:
  static Specification specification() {
    Specification specification;
    specification.file("path", "CSV or HDF5 (.h5, .hdf5) file with columns x, y, z and, as wanted, volume and area");
    specification.real("spacing", "mean distance of neighbouring particles; the smoothing length counts in it")
        .unit("m")
        .above(0);
    specification.real("volume", "volume of the part, shared equally; needed when the file has no volumes")
        .unit("m^3")
        .above(0)
        .optional();
    return specification;
  }

  ParticleFile(const Teuchos::ParameterList& list, const Context& context)
      : path_(list.get<std::string>("path")),
        input_path_(list.name()),
        spacing_(list.get<double>("spacing")),
        volume_(list.isParameter("volume") ? list.get<double>("volume") : 0.0),
        communicator_(context.communicator) {}

  ParticleCloud cloud() const override {
    const std::string extension = std::filesystem::path(path_).extension().string();
    const Columns columns = extension == ".h5" || extension == ".hdf5" ? hdf5_columns() : csv_columns();
    ParticleCloud cloud;
    cloud.spacing = spacing_;
    const std::size_t number = columns.x.size();
    for (std::size_t i = 0; i < number; ++i) {
      cloud.positions.push_back({columns.x[i], columns.y[i], columns.z[i]});
      for (const double coordinate : cloud.positions.back()) {
        if (!std::isfinite(coordinate)) {
          throw FileError(path_, columns.place(i),
                          fmt::format("the position is ({}, {}, {})", columns.x[i], columns.y[i], columns.z[i]),
                          "finite coordinates in m");
        }
      }
    }
    cloud.volumes = columns.volume;
    if (cloud.volumes.empty()) {
      if (volume_ <= 0.0) {
        throw InputError(input_path_ + ".volume", fmt::format("is missing, and {} has no volumes", path_),
                         "the part's volume in m^3, or a column 'volume'");
      }
      cloud.volumes.assign(number, volume_ / static_cast<double>(number));
    }
    cloud.heated_areas = columns.area;
    cloud.heated_areas.resize(number, 0.0);
    for (std::size_t i = 0; i < number; ++i) {
      if (!std::isfinite(cloud.volumes[i]) || cloud.volumes[i] <= 0.0) {
        throw FileError(path_, columns.place(i), fmt::format("the volume is {}", cloud.volumes[i]),
                        "a finite volume in m^3 above 0");
      }
      if (!std::isfinite(cloud.heated_areas[i]) || cloud.heated_areas[i] < 0.0) {
        throw FileError(path_, columns.place(i), fmt::format("the area is {}", cloud.heated_areas[i]),
                        "a finite area in m^2, 0 where no heat enters");
      }
    }
    return cloud;
  }

 private:
  Columns csv_columns() const {
    const CsvColumns csv = read_csv_columns(path_, {"x", "y", "z"}, {"volume", "area"}, *communicator_);
    const auto column = [&csv](const std::string& name) {
      const int found = csv.find(name);
      return found < 0 ? std::vector<double>() : csv.values[found];
    };
    return {column("x"),    column("y"),
            column("z"),    column("volume"),
            column("area"), [lines = csv.lines](std::size_t i) { return fmt::format("line {}", lines[i]); }};
  }

  Columns hdf5_columns() const {
    const hdf5::File file = hdf5::File::read(path_, communicator_);
    const std::size_t number = file.reals("x", {0}).values.size();
    const auto column = [&](const std::string& name) {
      return file.has(name) ? file.reals(name, {number}).values : std::vector<double>();
    };
    if (number == 0) throw FileError(path_, "x", "has no entry");
    return {file.reals("x", {number}).values,
            file.reals("y", {number}).values,
            file.reals("z", {number}).values,
            column("volume"),
            column("area"),
            [](std::size_t i) { return fmt::format("entry {}", i); }};
  }

  std::string path_;
  std::string input_path_;
  double spacing_;
  double volume_;
  Teuchos::RCP<const Communicator> communicator_;
};

KILN_REGISTER(Particles, ParticleFile, "file", "particles in any arrangement, from a CSV or HDF5 file");

}  // namespace
}  // namespace kiln
