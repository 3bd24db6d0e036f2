#include "framework/driver/Checkpoint.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <limits>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Reserve.hpp"
#include "framework/files/Seal.hpp"
#include "framework/files/Unknown.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

constexpr long long format = 5;

/// For HDF5's own account of what a checkpoint holds.
constexpr std::uint64_t smallest_room = 65536;
/// For the first checkpoint, in unknowns: the state, the one of the Jacobian, and two earlier ones of the scheme.
constexpr std::uint64_t first_unknowns = 4;

/// First line in which two texts differ, as "'a' there, 'b' here".
std::string first_difference(const std::string& there, const std::string& here) {
  std::istringstream there_lines(there), here_lines(here);
  std::string there_line, here_line;
  while (true) {
    const bool more_there = static_cast<bool>(std::getline(there_lines, there_line));
    const bool more_here = static_cast<bool>(std::getline(here_lines, here_line));
    if (!more_there) there_line.clear();
    if (!more_here) here_line.clear();
    if (there_line != here_line || (!more_there && !more_here)) {
      return fmt::format("'{}' there, '{}' here", there_line, here_line);
    }
  }
}

}  // namespace

Checkpoint::Checkpoint(const Context& context, TimeScheme& scheme, std::string identity, const SolveTotals& solved)
    : method_(context.method),
      scheme_(scheme),
      communicator_(context.communicator),
      folder_(context.folder),
      identity_(std::move(identity)),
      solved_(solved),
      room_(smallest_room + identity_.size() +
            first_unknowns * sizeof(double) * method_.coordinates()->getGlobalNumElements()) {}

void Checkpoint::observe(const Moment& moment) {
  if (moment.step > 0) solved_.add(moment.solve);
  if (!moment.checkpoint) return;
  AtomicPath path(file(folder_), communicator_);
  {
    hdf5::File checkpoint = hdf5::create_with_room(path.temporary(), room_, communicator_);
    checkpoint.attribute("format", format);
    checkpoint.attribute("identity", identity_);
    checkpoint.attribute("step", moment.step);
    checkpoint.attribute("time", moment.time);
    checkpoint.attribute("residuals", solved_.residuals);
    checkpoint.attribute("iterations", solved_.iterations);
    checkpoint.attribute("capped_steps", solved_.capped_steps);
    checkpoint.attribute("most_left", solved_.most_left);
    save_unknown(checkpoint, "unknown", *method_.coordinates(), moment.x);
    hdf5::Group scheme = checkpoint.create_group("scheme");
    scheme_.save(scheme);
    hdf5::Group method = checkpoint.create_group("method");
    method_.save(method);
    // A disk that is full says so here or never: closing is silent.
    checkpoint.flush();
  }
  hdf5::seal(path.temporary(), *communicator_);
  path.commit();
  ++written_;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file(folder_), unknown);
  // An earlier state more or less, as a scheme starts, fits in as well.
  if (!unknown) room_ = size + size / 4;
}

void Checkpoint::finish(RunReport& report) {
  report.section("observers")["checkpoint"] = {{"file", file(folder_).filename().string()}, {"written", written_}};
}

Checkpoint::Resumed Checkpoint::restore(const std::filesystem::path& folder, const std::string& identity,
                                        Method& method, TimeScheme& scheme, VectorView x, int last_step,
                                        const Teuchos::RCP<const Communicator>& communicator) {
  const std::string path = file(folder).string();
  const hdf5::File checkpoint = hdf5::File::read(path, communicator);
  if (checkpoint.integer("format") != format) {
    throw FileError(path, "attribute format", fmt::format("version {}", checkpoint.integer("format")),
                    fmt::format("version {}, which this Kiln writes", format));
  }
  checkpoint.require_seal();
  const std::string saved = checkpoint.text("identity");
  if (saved != identity) {
    throw FileError(path, "", "is the checkpoint of another run: " + first_difference(saved, identity),
                    "the same model, time and method blocks");
  }
  restore_unknown(checkpoint, "unknown", *method.coordinates(), x);
  // The scheme evaluates states and rates at the rows, which the method must have found again by then.
  method.restore(checkpoint.group("method"));
  scheme.restore(checkpoint.group("scheme"));
  const auto step = static_cast<int>(checkpoint.integer("step", 0, last_step));
  constexpr long long any = std::numeric_limits<long long>::max();
  return {step,
          {step, checkpoint.integer("residuals", 0, any), checkpoint.integer("iterations", 0, any),
           checkpoint.integer("capped_steps", 0, step), checkpoint.finite_real("most_left")}};
}

}  // namespace kiln
