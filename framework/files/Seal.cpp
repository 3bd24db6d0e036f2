#include "framework/files/Seal.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "framework/base/Error.hpp"
#include "framework/base/Hash.hpp"
#include "framework/files/Hdf5Node.hpp"
#include "framework/files/Together.hpp"

namespace kiln::hdf5 {
namespace {

using Word = std::uint64_t;
constexpr std::size_t word = sizeof(Word);
constexpr std::size_t segment_words = 5;
constexpr std::size_t footer_words = 5;
constexpr char mark[] = {'K', 'I', 'L', 'N', 'S', 'E', 'A', 'L'};
constexpr const char* changed = "is damaged: it is not what was written";
constexpr const char* intact = "the file as Kiln wrote it";

void append(std::string& bytes, Word value) {
  for (std::size_t i = 0; i < word; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

Word word_at(const std::string& bytes, std::size_t index) {
  Word value = 0;
  for (std::size_t i = 0; i < word; ++i) {
    value |= static_cast<Word>(static_cast<unsigned char>(bytes[word * index + i])) << (8 * i);
  }
  return value;
}

[[noreturn]] void fail_to(const std::string& done, const std::string& path) {
  const int error = errno;
  throw FileError(path, "", fmt::format("cannot be {}: {}", done, std::strerror(error)));
}

std::string read_bytes(std::ifstream& file, const std::string& path, Word offset, Word length) {
  std::string bytes(length, '\0');
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(bytes.data(), static_cast<std::streamsize>(length));
  if (!file) fail_to("read", path);
  return bytes;
}

struct Hash {
  Word low, high;
};

Hash hash_of_bytes(const std::string& bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

Hash hash_of_part(std::ifstream& file, const std::string& path, Word offset, Word length) {
  // The same memory whatever the file's size.
  std::vector<char> piece(std::size_t{1} << 16);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  file.seekg(static_cast<std::streamoff>(offset));
  for (Word left = length; left > 0;) {
    const auto size = static_cast<std::size_t>(std::min<Word>(piece.size(), left));
    if (!file.read(piece.data(), static_cast<std::streamsize>(size))) fail_to("read", path);
    XXH3_128bits_update(state.get(), piece.data(), size);
    left -= size;
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return {hash.low64, hash.high64};
}

std::ifstream open_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to("read", path);
  return file;
}

Word size_of(const std::string& path) {
  std::error_code error;
  const Word size = std::filesystem::file_size(path, error);
  if (error) throw FileError(path, "", "cannot be read: " + error.message());
  return size;
}

/// Where the values of large contiguous datasets lie, ascending.
std::vector<Segment> large_parts(const std::string& path) {
  std::vector<Segment> parts;
  const Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const auto visit = [](hid_t root, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Id dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
    const haddr_t offset = H5Dget_offset(dataset);
    const hsize_t length = H5Dget_storage_size(dataset);
    if (offset == HADDR_UNDEF || length < large_dataset) return 0;
    static_cast<std::vector<Segment>*>(found)->push_back({offset, length, true, 0, 0});
    return 0;
  };
  if (!file.valid() || H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &parts, H5O_INFO_BASIC) < 0) {
    throw FileError(path, "", "cannot be read" + reason());
  }
  std::sort(parts.begin(), parts.end(), [](const Segment& a, const Segment& b) { return a.offset < b.offset; });
  return parts;
}

/// The parts and what lies between them.
std::vector<Segment> segments_of(const std::vector<Segment>& large, Word length) {
  std::vector<Segment> segments;
  Word at = 0;
  for (const Segment& part : large) {
    if (part.offset > at) segments.push_back({at, part.offset - at, false, 0, 0});
    segments.push_back(part);
    at = part.offset + part.length;
  }
  if (at < length) segments.push_back({at, length - at, false, 0, 0});
  return segments;
}

std::string bytes_of(const std::vector<Segment>& segments, Word sealed) {
  std::string bytes;
  for (const Segment& segment : segments) {
    append(bytes, segment.offset);
    append(bytes, segment.length);
    append(bytes, segment.large ? 1 : 0);
    append(bytes, segment.hash_low);
    append(bytes, segment.hash_high);
  }
  bytes.append(mark, sizeof mark);
  append(bytes, sealed);
  append(bytes, segments.size());
  const Hash hash = hash_of_bytes(bytes);
  append(bytes, hash.low);
  append(bytes, hash.high);
  return bytes;
}

void seal_alone(const std::string& path) {
  const std::vector<Segment> before = read_seal(path, false);
  if (!before.empty()) {
    std::error_code error;
    std::filesystem::resize_file(path, before.back().offset + before.back().length, error);
    if (error) throw FileError(path, "", "cannot be written: " + error.message());
  }
  const Word length = size_of(path);
  std::vector<Segment> segments = segments_of(large_parts(path), length);
  {
    std::ifstream file = open_file(path);
    for (Segment& segment : segments) {
      const Hash hash = hash_of_part(file, path, segment.offset, segment.length);
      segment.hash_low = hash.low;
      segment.hash_high = hash.high;
    }
  }
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << bytes_of(segments, length);
  file.close();
  if (!file) fail_to("written", path);
}

}  // namespace

void seal(const std::string& path, const Communicator& communicator) {
  communicator.barrier();
  on_root(communicator, path, [&path]() -> std::optional<Fault> {
    seal_alone(path);
    return std::nullopt;
  });
}

std::vector<Segment> read_seal(const std::string& path, bool check) {
  const Word size = size_of(path);
  constexpr Word footer = footer_words * word;
  if (size < footer) return {};
  std::ifstream file = open_file(path);
  const std::string end = read_bytes(file, path, size - footer, footer);
  if (end.compare(0, sizeof mark, mark, sizeof mark) != 0) return {};
  const FileError damaged(path, "seal", changed, intact);
  const Word sealed = word_at(end, 1), count = word_at(end, 2);
  const Word table = size - footer - sealed;
  if (sealed > size - footer || count != table / (segment_words * word) || table % (segment_words * word) != 0) {
    throw damaged;
  }
  const std::string bytes = read_bytes(file, path, sealed, table) + end;
  const Hash hash = hash_of_bytes(bytes.substr(0, bytes.size() - 2 * word));
  if (hash.low != word_at(end, 3) || hash.high != word_at(end, 4)) throw damaged;
  std::vector<Segment> segments;
  Word at = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const std::size_t first = s * segment_words;
    segments.push_back({word_at(bytes, first), word_at(bytes, first + 1), word_at(bytes, first + 2) == 1,
                        word_at(bytes, first + 3), word_at(bytes, first + 4)});
    const Segment& segment = segments.back();
    if (segment.offset != at || segment.length > sealed - at) throw damaged;
    at += segment.length;
  }
  if (at != sealed) throw damaged;
  for (const Segment& segment : segments) {
    if (check && !segment.large) check_segment(path, segment, "");
  }
  return segments;
}

std::string fingerprint(const std::vector<Segment>& seal) {
  return hash_of(bytes_of(seal, seal.empty() ? 0 : seal.back().offset + seal.back().length));
}

void check_segment(const std::string& path, const Segment& segment, const std::string& place) {
  std::ifstream file = open_file(path);
  const Hash hash = hash_of_part(file, path, segment.offset, segment.length);
  if (hash.low == segment.hash_low && hash.high == segment.hash_high) return;
  throw FileError(
      path, place.empty() ? fmt::format("bytes {} to {}", segment.offset, segment.offset + segment.length) : place,
      changed, intact);
}

}  // namespace kiln::hdf5
