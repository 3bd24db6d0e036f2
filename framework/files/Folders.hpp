#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>

namespace kiln {

// Where the results of a checked input go: all are below `output.directory`.

/// Folder of a run: named by the method, so that full-order and reduced runs of one input stand side by side.
inline std::filesystem::path run_folder(const Teuchos::ParameterList& input) {
  return std::filesystem::path(input.sublist("output").get<std::string>("directory")) /
         input.sublist("method").get<std::string>("type");
}

/// Folder of the training's report.
inline std::filesystem::path training_folder(const Teuchos::ParameterList& input) {
  return std::filesystem::path(input.sublist("output").get<std::string>("directory")) / "training";
}

/// The reduction file that `kiln train` writes and reduced runs read.
inline std::filesystem::path reduction_file(const Teuchos::ParameterList& input) {
  return std::filesystem::path(input.sublist("output").get<std::string>("directory")) / "reduction.h5";
}

}  // namespace kiln
