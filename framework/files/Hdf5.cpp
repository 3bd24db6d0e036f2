#include "framework/files/Hdf5.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5Node.hpp"
#include "framework/files/Hdf5Vet.hpp"
#include "framework/files/Reserve.hpp"
#include "framework/files/Seal.hpp"
#include "framework/files/Together.hpp"

namespace kiln::hdf5 {
namespace {

/// HDF5 prints its own error stack unless told not to, and would load a library to understand a file's compression.
void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

Id access_properties(const Communicator& communicator, bool parallel) {
  Id properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // A file that a run is writing may be looked at meanwhile; the run's folder is what keeps a second run out.
  H5Pset_file_locking(properties, false, true);
  // What is written goes to the system at once: a program that is killed must not take small blocks with it.
  H5Pset_sieve_buf_size(properties, 0);
  if (parallel && H5Pset_fapl_mpio(properties, mpi_communicator(communicator), MPI_INFO_NULL) < 0) {
    return Id(H5I_INVALID_HID, H5Pclose);
  }
  return properties;
}

std::optional<Fault> cannot_open(const std::string& path, int flags, const std::string& purpose) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return Fault{"", "is a folder", "an HDF5 file"};
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor < 0) return system_fault(purpose, errno);
  ::close(descriptor);
  return std::nullopt;
}

std::optional<Fault> not_hdf5(const std::string& path) {
  silence();
  if (H5Fis_hdf5(path.c_str()) > 0) return std::nullopt;
  H5Eclear2(H5E_DEFAULT);
  return Fault{"", "is not an HDF5 file", "a file that begins with HDF5's signature"};
}

std::shared_ptr<Node> root_of(const std::string& path, const Teuchos::RCP<const Communicator>& communicator,
                              bool parallel, Id id, const std::string& done) {
  std::optional<Fault> fault;
  if (!id.valid()) {
    // What vanished while it was being opened HDF5 does not call so.
    fault =
        ::access(path.c_str(), F_OK) != 0 ? system_fault(done, errno) : Fault{"", "cannot be " + done + reason(), ""};
    H5Eclear2(H5E_DEFAULT);
  }
  throw_together(*communicator, path, fault);
  const auto file = std::make_shared<OpenFile>(OpenFile{path, communicator, parallel, std::move(id)});
  Id root(H5Gopen2(file->id, "/", H5P_DEFAULT), H5Gclose);
  const auto node = std::make_shared<Node>(Node{file, "/", std::move(root)});
  node->require(node->id.valid(), "", "opened");
  return node;
}

bool link_exists(hid_t group, const std::string& name) {
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const std::string prefix = name.substr(0, slash);
    if (prefix != "/" && H5Lexists(group, prefix.c_str(), H5P_DEFAULT) <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    if (slash == std::string::npos) return true;
  }
}

}  // namespace

void Node::fail(const std::string& name, const std::string& found, const std::string& expected) const {
  throw FileError(file->path, name.empty() ? path : path_of(name), found, expected);
}

void Node::require(bool succeeded, const std::string& name, const std::string& done) const {
  unsigned intent = H5F_ACC_RDONLY;
  if (!succeeded && H5Fget_intent(file->id, &intent) >= 0 && (intent & H5F_ACC_RDWR) != 0) note_failed_writing();
  const std::string why = succeeded ? "" : reason();
  throw_together(communicator(), file->path,
                 succeeded
                     ? std::nullopt
                     : std::optional<Fault>(Fault{name.empty() ? path : path_of(name), "cannot be " + done + why, ""}));
}

std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& innermost = *static_cast<std::string*>(data);
        if (innermost.empty() && error->desc != nullptr) innermost = error->desc;
        return 0;
      },
      &text);
  H5Eclear2(H5E_DEFAULT);
  // Of a failed write HDF5 tells addresses and line ends, too.
  const std::size_t end = text.find(", buf = ");
  if (end != std::string::npos) text.erase(end);
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  return text.empty() ? text : " (" + text + ")";
}

MPI_Comm mpi_communicator(const Communicator& communicator) {
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&communicator);
  return mpi == nullptr ? MPI_COMM_SELF : (*mpi->getRawMpiComm())();
}

bool Group::has(const std::string& name) const { return link_exists(node_->id, name); }

Group Group::group(const std::string& name) const {
  if (!has(name)) node_->fail(name, "is missing", "a group");
  Id id(H5Gopen2(node_->id, name.c_str(), H5P_DEFAULT), H5Gclose);
  H5Eclear2(H5E_DEFAULT);
  if (!id.valid()) node_->fail(name, "is not a group", "a group");
  return Group(std::make_shared<Node>(Node{node_->file, node_->path_of(name), std::move(id)}));
}

Group Group::create_group(const std::string& name) {
  Id id(H5Gcreate2(node_->id, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  node_->require(id.valid(), name, "created");
  return Group(std::make_shared<Node>(Node{node_->file, node_->path_of(name), std::move(id)}));
}

std::vector<std::string> Group::names() const {
  std::vector<std::string> found;
  const herr_t status = H5Literate(
      node_->id, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &found);
  if (status < 0) node_->fail("", "cannot be listed" + reason());
  std::sort(found.begin(), found.end());
  return found;
}

const std::string& Group::file() const { return node_->file->path; }
const std::string& Group::path() const { return node_->path; }
const Communicator& Group::communicator() const { return node_->communicator(); }

File File::create(const std::string& path, const Teuchos::RCP<const Communicator>& communicator) {
  silence();
  on_root(*communicator, path, [&] { return cannot_open(path, O_WRONLY | O_CREAT, "written"); });
  const bool parallel = communicator->getSize() > 1;
  const Id access = access_properties(*communicator, parallel);
  Id id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  return File(root_of(path, communicator, parallel, std::move(id), "created"));
}

File File::read(const std::string& path, const Teuchos::RCP<const Communicator>& communicator) {
  silence();
  std::vector<Segment> segments;
  on_root(*communicator, path, [&]() -> std::optional<Fault> {
    if (const auto fault = cannot_open(path, O_RDONLY, "read")) return fault;
    if (const auto fault = not_hdf5(path)) return fault;
    segments = read_seal(path, true);
    return segments.empty() ? vet(path) : std::nullopt;
  });
  const std::string known = broadcast(*communicator, segments.empty() ? std::string() : hdf5::fingerprint(segments));
  // Each rank reads by itself: reading needs no agreement, and many small readings then cost no communication.
  const Id access = access_properties(*communicator, false);
  Id id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  File file(root_of(path, communicator, false, std::move(id), "read"));
  OpenFile& opened = *file.node_->file;
  opened.fingerprint = known;
  opened.checked.resize(segments.size(), false);
  opened.seal = std::move(segments);
  return file;
}

File File::modify(const std::string& path, const Teuchos::RCP<const Communicator>& communicator) {
  silence();
  on_root(*communicator, path, [&]() -> std::optional<Fault> {
    if (const auto fault = cannot_open(path, O_RDWR, "written")) return fault;
    if (const auto fault = not_hdf5(path)) return fault;
    return read_seal(path, true).empty() ? vet(path) : std::nullopt;
  });
  const bool parallel = communicator->getSize() > 1;
  const Id access = access_properties(*communicator, parallel);
  Id id(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), H5Fclose);
  return File(root_of(path, communicator, parallel, std::move(id), "opened"));
}

void File::require_seal() const {
  if (!node_->file->fingerprint.empty()) return;
  throw FileError(file(), "", "carries no seal: it was cut short, changed, or written by another version of Kiln",
                  "the file as this version of Kiln wrote it");
}

const std::string& File::fingerprint() const { return node_->file->fingerprint; }

void File::flush() { node_->require(H5Fflush(node_->file->id, H5F_SCOPE_GLOBAL) >= 0, "", "written"); }

void File::was_renamed(const std::string& path) { node_->file->path = path; }

}  // namespace kiln::hdf5
