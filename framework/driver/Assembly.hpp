#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/input/Input.hpp"
#include "framework/method/Method.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/time/TimeLoop.hpp"

namespace kiln {

/// Everything one run is made of, built from its input in the order in which the parts need each other.
class Assembly {
 public:
  /// `data`: data_identity of the input; `folder`: where the outputs go. With `restart` the run goes on from the
  /// checkpoint there. Throws InputError and FileError for what does not fit. Collective.
  Assembly(const Input& input, const std::string& data, const std::filesystem::path& folder,
           const Teuchos::RCP<const Communicator>& communicator, bool restart);

  void add(std::unique_ptr<Observer> observer) { observers_.push_back(std::move(observer)); }
  /// Makes the files of the outputs. Collective.
  void begin();
  /// run_time_loop() from where the run stands. Collective.
  void march(LoopTotals& totals);
  /// What the outputs and the method have to report. Collective.
  void finish(RunReport& report);

  const TimeSpan& span() const { return span_; }
  /// Of the steps that an earlier part of the run took.
  const SolveTotals& solved_before() const { return solved_before_; }
  const Method& method() const { return *method_; }

 private:
  TimeSpan span_;
  SolveTotals solved_before_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<TimeScheme> scheme_;
  VectorView x_;
  std::vector<std::unique_ptr<Observer>> observers_;
};

}  // namespace kiln
