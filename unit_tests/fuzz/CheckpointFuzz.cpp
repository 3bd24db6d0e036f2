#include "framework/driver/Checkpoint.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/input/Input.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/time/TimeLoop.hpp"
#include "unit_tests/fuzz/Edits.hpp"
#include "unit_tests/fuzz/Harness.hpp"

// Checkpoints. First byte: 0 to 7: the others are the file; else they are edits of a sound one.

namespace {

/// The run whose checkpoint it is.
struct Run {
  Run()
      : input(kiln::Input::read(kiln::fuzz::sound("tiny.yaml"), {"time.end=300 us"}, kiln::run_specification(),
                                *kiln::fuzz::alone())),
        span(kiln::TimeSpan::of(input.list())),
        method(
            kiln::Registry<kiln::Method>::create(input.list().sublist("method"), {input.list(), kiln::fuzz::alone()})),
        scheme(kiln::Registry<kiln::TimeScheme>::create(input.list().sublist("time").sublist("scheme"),
                                                        {*method, span.step})),
        x("x", kiln::local_size(*method->coordinates())) {
    const kiln::hdf5::File file =
        kiln::hdf5::File::read(kiln::fuzz::sound("results/fom/checkpoint.h5"), kiln::fuzz::alone());
    identity = file.text("identity");
  }
  kiln::Input input;
  kiln::TimeSpan span;
  std::unique_ptr<kiln::Method> method;
  std::unique_ptr<kiln::TimeScheme> scheme;
  kiln::VectorView x;
  std::string identity;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  kiln::fuzz::initialise();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kiln;
  if (size == 0) return -1;
  static const std::string whole = fuzz::read(fuzz::sound("results/fom/checkpoint.h5"));
  static const std::vector<fuzz::Part> parts = fuzz::parts_of(fuzz::sound("results/fom/checkpoint.h5"));
  static const auto& run = *new Run();
  const std::string file = fuzz::scratch("checkpoint.h5");
  if (data[0] < 8) {
    fuzz::write(file, data + 1, size - 1);
  } else {
    fuzz::write(file, reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size());
    fuzz::edit(file, parts, data + 1, size - 1);
  }
  fuzz::refuses_or_does([&] {
    const int step = Checkpoint::restore(fuzz::scratch(""), run.identity, *run.method, *run.scheme, run.x,
                                         run.span.last_step, fuzz::alone())
                         .step;
    if (step < 0 || step > run.span.last_step) fuzz::found("a step outside the run");
  });
  return 0;
}
