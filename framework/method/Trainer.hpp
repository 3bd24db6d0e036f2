#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {

/// The offline stage behind `kiln train`: runs the full-order model, learns a reduction from it and writes one
/// self-contained reduction file. The block `reduction:` of the input picks and sets one.
class Trainer {
 public:
  struct Context {
    const Teuchos::ParameterList& input;  ///< the whole checked input
    Teuchos::RCP<const Communicator> communicator;
    bool quiet = false;  ///< no progress bar
  };
  static constexpr const char* category = "trainer";

  virtual ~Trainer() = default;
  /// Throws InputError for mistakes that only the model can tell, such as parameters that it does not have: before a
  /// training replaces what an earlier one left. Collective.
  virtual void check() = 0;
  /// Checks first, where that has not been done. Writes `file` at once at the end: either whole or not at all.
  /// Collective.
  virtual void train(const std::filesystem::path& file, RunReport& report) = 0;
};

}  // namespace kiln
