#pragma once

#include <string>
#include <vector>

namespace kiln {

/// The candidate closest to a word in edit distance (insertions, deletions, substitutions, swaps of neighbours; case
/// ignored), if it is close enough to be what was meant: at most a third of the word's length, and at least one edit
/// is always allowed. Empty otherwise.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace kiln
