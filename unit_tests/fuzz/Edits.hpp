#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Changes to the contents of a sound HDF5 file as a fuzzer's bytes dictate them: a flipped bit in the file itself
/// would only show again that its seal is broken.
namespace kiln::fuzz {

/// A dataset, or an attribute of an object.
struct Part {
  std::string object;
  std::string attribute;  ///< empty: the object is a dataset
};

/// All datasets and attributes of a file, in a fixed order.
std::vector<Part> parts_of(const std::string& path);

/// Each edit takes 12 bytes: what is done, to which part, and a number. Datasets lose rows, elements, or themselves, or
/// become another type, or huge; attributes take other values and types. The result is sealed.
void edit(const std::string& path, const std::vector<Part>& parts, const std::uint8_t* data, std::size_t size);

}  // namespace kiln::fuzz
