#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "framework/input/Input.hpp"

namespace kiln::test {

/// A fresh folder with input files. Rank 0 alone works in it and writes to it: the others must learn all from rank 0.
class InputTest : public testing::Test {
 protected:
  using Lines = std::vector<std::string>;

  InputTest();
  ~InputTest() override;

  void write(const std::string& file, const std::string& text) const;
  /// Reads run.yaml.
  Input read(const Lines& overrides = {}) const;
  Input read_text(const std::string& text, const Lines& overrides = {}) const;
  /// The lines of the error that reading run.yaml ends with; empty: it was read. The folder's path is "{folder}".
  Lines mistakes(const Lines& overrides = {}, const std::string& file = "run.yaml") const;
  Lines mistakes_of(const std::string& text, const Lines& overrides = {}) const;

  Teuchos::RCP<const Communicator> communicator_;
  std::string folder_;

 private:
  std::filesystem::path before_;
};

inline Teuchos::Array<double> reals(const std::vector<double>& values) { return Teuchos::Array<double>(values); }

/// A model block with what is required, to which a test adds.
inline const std::string model = "model:\n  spacing: 1 mm\n  heat_source: {type: gaussian lamp, power: 40 W}\n";

}  // namespace kiln::test
