#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

/// A seal is a table of hashes (XXH3, 128 bits) behind the last byte of an HDF5 file, which HDF5 does not look at. It
/// tells a file that a disk, a network or an editor has changed from one that Kiln wrote, before HDF5, which is easily
/// led astray by a damaged file, looks at it.
///
/// All bytes but the large datasets' are one or more segments that are checked when the file is opened: what an online
/// run of a hyper-reduced model reads. A large dataset is a segment of its own and is checked when it is read.
///
/// Layout, little-endian, unsigned 64-bit words: for each segment its offset, its length, 1 if it is a large dataset
/// (else 0), low and high half of its hash; then the footer: "KILNSEAL", the length of what is sealed, the number of
/// segments, low and high half of the hash of all words of the seal before.
namespace kiln::hdf5 {

struct Segment {
  std::uint64_t offset;
  std::uint64_t length;
  bool large;  ///< a dataset's values, checked when they are read
  std::uint64_t hash_low, hash_high;
};

/// Datasets from this size on are large.
constexpr std::uint64_t large_dataset = std::uint64_t{1} << 20;

/// Seals a closed HDF5 file, anew if it is sealed already. Throws FileError. Collective; rank 0 does the work.
void seal(const std::string& path, const Communicator& communicator);

/// The segments of a sealed file; empty: there is no seal. Throws FileError for a seal that is itself damaged, and if
/// `check` for any segment that is not large and differs from its hash. Not collective.
std::vector<Segment> read_seal(const std::string& path, bool check);

/// Tells sealed files apart: a hash of the seal's own hashes. Files of the same bytes have the same.
std::string fingerprint(const std::vector<Segment>& seal);

/// Throws FileError, naming `place`, unless the segment's bytes are those that were sealed. Not collective.
void check_segment(const std::string& path, const Segment& segment, const std::string& place);

}  // namespace kiln::hdf5
