#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// A kind of file that users write.
struct InputKind {
  std::string name;   ///< of the page
  std::string title;  ///< of the file
  Specification specification;
};

/// The pages of the reference, Markdown by file name: one for each kind of file, one for each category of components,
/// and an index of both.
std::map<std::string, std::string> reference_pages(const std::vector<InputKind>& kinds);

}  // namespace kiln
