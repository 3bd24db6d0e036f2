#include "framework/plugin/SharedLibrary.hpp"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

namespace kiln {
namespace {

/// A library of one segment: header, table, 100 bytes.
std::string library() {
  Elf64_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_type = ET_DYN;
  header.e_phoff = sizeof(Elf64_Ehdr);
  header.e_phnum = 1;
  Elf64_Phdr segment{};
  segment.p_offset = sizeof(Elf64_Ehdr) + sizeof(Elf64_Phdr);
  segment.p_filesz = 100;
  std::string bytes(segment.p_offset + segment.p_filesz, 'x');
  std::memcpy(bytes.data(), &header, sizeof(header));
  std::memcpy(bytes.data() + sizeof(header), &segment, sizeof(segment));
  return bytes;
}

TEST(SharedLibrary, TakesAWholeOne) { EXPECT_EQ(shared_library_problem(library()), ""); }

TEST(SharedLibrary, RefusesOneThatIsCutShortAnywhere) {
  const std::string bytes = library();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(shared_library_problem(bytes.substr(0, size)), size < SELFMAG ? "is no shared library" : "is cut short")
        << size;
  }
}

TEST(SharedLibrary, RefusesSizesThatOverflow) {
  std::string bytes = library();
  Elf64_Phdr segment{};
  segment.p_offset = std::numeric_limits<Elf64_Off>::max() - 10;
  segment.p_filesz = 100;
  std::memcpy(bytes.data() + sizeof(Elf64_Ehdr), &segment, sizeof(segment));
  EXPECT_EQ(shared_library_problem(bytes), "is cut short");
  Elf64_Ehdr header{};
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.e_phoff = std::numeric_limits<Elf64_Off>::max() - 1;
  std::memcpy(bytes.data(), &header, sizeof(header));
  EXPECT_EQ(shared_library_problem(bytes), "is cut short");
}

TEST(SharedLibrary, RefusesProgramsAndOtherFiles) {
  std::string bytes = library();
  Elf64_Ehdr header{};
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.e_type = ET_EXEC;
  std::memcpy(bytes.data(), &header, sizeof(header));
  EXPECT_EQ(shared_library_problem(bytes), "is no shared library of 64 bits");
  EXPECT_EQ(shared_library_problem(std::string(1000, 'x')), "is no shared library");
}

}  // namespace
}  // namespace kiln
