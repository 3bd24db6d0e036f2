#include "unit_tests/framework/input/InputTest.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "unit_tests/framework/input/TestComponents.hpp"

namespace kiln::test {

InputTest::InputTest() : communicator_(Tpetra::getDefaultComm()), before_(std::filesystem::current_path()) {
  std::string name = (std::filesystem::temp_directory_path() / "kiln-input-XXXXXX").string();
  if (communicator_->getRank() == 0 && mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("no folder can be made at " + name);
  }
  Teuchos::broadcast(*communicator_, 0, static_cast<int>(name.size()), name.data());
  folder_ = name;
  if (communicator_->getRank() == 0) std::filesystem::current_path(folder_);
}

InputTest::~InputTest() {
  std::filesystem::current_path(before_);
  if (communicator_->getRank() == 0) std::filesystem::remove_all(folder_);
}

void InputTest::write(const std::string& file, const std::string& text) const {
  if (communicator_->getRank() != 0) return;
  const std::filesystem::path path = std::filesystem::path(folder_) / file;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

Input InputTest::read(const Lines& overrides) const {
  return Input::read("run.yaml", overrides, run_specification(), *communicator_);
}

Input InputTest::read_text(const std::string& text, const Lines& overrides) const {
  write("run.yaml", text);
  return read(overrides);
}

InputTest::Lines InputTest::mistakes(const Lines& overrides, const std::string& file) const {
  Lines lines;
  try {
    Input::read(file, overrides, run_specification(), *communicator_);
  } catch (const InputError& error) {
    std::istringstream stream(error.what());
    for (std::string line; std::getline(stream, line);) {
      for (std::size_t at = line.find(folder_); at != std::string::npos; at = line.find(folder_)) {
        line.replace(at, folder_.size(), "{folder}");
      }
      lines.push_back(line);
    }
  }
  return lines;
}

InputTest::Lines InputTest::mistakes_of(const std::string& text, const Lines& overrides) const {
  write("run.yaml", text);
  return mistakes(overrides);
}

}  // namespace kiln::test
