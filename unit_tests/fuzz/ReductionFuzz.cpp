#include "framework/driver/RunSpecification.hpp"
#include "framework/input/Input.hpp"
#include "framework/method/Method.hpp"
#include "framework/registry/Registry.hpp"
#include "unit_tests/fuzz/Edits.hpp"
#include "unit_tests/fuzz/Harness.hpp"

// Reduction files, as GNAT and LSPG read them. First byte: 0 to 7: the others are the file; else they are edits of a
// sound one.

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  kiln::fuzz::initialise();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kiln;
  if (size == 0) return -1;
  static const std::string whole = fuzz::read(fuzz::sound("results/reduction.h5"));
  static const std::vector<fuzz::Part> parts = fuzz::parts_of(fuzz::sound("results/reduction.h5"));
  static const Input gnat = Input::read(fuzz::sound("gnat.yaml"), {}, run_specification(), *fuzz::alone());
  static const Input lspg = Input::read(fuzz::sound("lspg.yaml"), {}, run_specification(), *fuzz::alone());
  const std::string file = fuzz::scratch("reduction.h5");
  if (data[0] < 8) {
    fuzz::write(file, data + 1, size - 1);
  } else {
    fuzz::write(file, reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size());
    fuzz::edit(file, parts, data + 1, size - 1);
  }
  Teuchos::ParameterList input = (data[0] % 2 == 0 ? gnat : lspg).list();
  input.sublist("method").set("file", file);
  fuzz::refuses_or_does([&] {
    const auto method = Registry<Method>::create(input.sublist("method"), {input, fuzz::alone()});
    const VectorView x("x", local_size(*method->coordinates()));
    method->initial(x);
    const VectorView u("u", method->positions().extent(0) * method->fields().size());
    method->state(x, u);
  });
  return 0;
}
