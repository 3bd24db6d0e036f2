#include "framework/plugin/SharedLibrary.hpp"

#include <elf.h>

#include <cstring>

namespace kiln {
namespace {

/// Whether `size` bytes from `offset` on lie within the file.
bool holds(std::string_view bytes, std::size_t offset, std::size_t size) {
  return offset <= bytes.size() && size <= bytes.size() - offset;
}

/// A copy, since the bytes need not be aligned. The caller has asked holds().
template <class T>
T at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace

std::string shared_library_problem(std::string_view bytes) {
  if (!holds(bytes, 0, SELFMAG) || std::memcmp(bytes.data(), ELFMAG, SELFMAG) != 0) return "is no shared library";
  if (!holds(bytes, 0, sizeof(Elf64_Ehdr))) return "is cut short";
  const auto header = at<Elf64_Ehdr>(bytes, 0);
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_type != ET_DYN) return "is no shared library of 64 bits";
  for (std::size_t k = 0; k < header.e_phnum; ++k) {
    const std::size_t offset = header.e_phoff + k * sizeof(Elf64_Phdr);
    if (!holds(bytes, offset, sizeof(Elf64_Phdr))) return "is cut short";
    const auto segment = at<Elf64_Phdr>(bytes, offset);
    if (!holds(bytes, segment.p_offset, segment.p_filesz)) return "is cut short";
  }
  return {};
}

}  // namespace kiln
