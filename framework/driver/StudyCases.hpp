#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/driver/Placeholders.hpp"
#include "framework/input/Input.hpp"

namespace kiln {

/// One case of a study's matrix: an input, what is changed in it, and what to do with it.
struct StudyCase {
  struct Override {
    std::string text;   ///< "path.to.key=value"
    std::string place;  ///< dotted path of its entry in the study file
  };

  std::string name;
  std::string place;  ///< dotted path of its block in the study file, e.g. "cases.3"
  PlaceholderValues values;
  std::string input;    ///< the input file
  std::string command;  ///< "run" or "train"
  std::vector<Override> overrides;
  std::optional<std::size_t> needs;  ///< index of an earlier case
  std::filesystem::path folder;      ///< output/name

  /// The texts of `overrides`, and the one that sends the results into `folder`.
  std::vector<std::string> all_overrides() const;
};

/// The matrix of a study file (study_specification()), in its order. `working_folder` is what the study's `output` is
/// relative to; {needs} becomes an absolute folder. Throws InputError with all mistakes, placed in the study file.
std::vector<StudyCase> expand_study(const Input& study, const std::filesystem::path& working_folder);

}  // namespace kiln
