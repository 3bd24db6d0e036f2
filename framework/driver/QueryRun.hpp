#pragma once

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <vector>

#include "framework/queries/QueryAnswers.hpp"
#include "framework/report/RunReport.hpp"
#include "framework/time/TimeLoop.hpp"

namespace kiln {

/// A run that answers many points of the model's live parameters (the block `queries`): histories of the input's
/// probes for each.
///
/// Ranks share the points, not the particles: each rank has a method of its own and whole blocks of points, so that
/// nothing is communicated while stepping, and no answer depends on the number of ranks, bit by bit. A method that
/// offers it (AdvancesTogether) advances a block's points together; else each point has a run of its own.
class QueryRun {
 public:
  /// Builds everything. Throws InputError and FileError for what does not fit. Collective.
  QueryRun(const Teuchos::ParameterList& input, Teuchos::RCP<const Communicator> communicator);

  /// Answers all points. A point that diverges is marked and stops no other. Throws InputError, on every rank, for a
  /// point that the model refuses, and Stopped where a signal asks for the end. Collective.
  const QueryAnswers& answer();
  /// Adds points, divergences and sums over all points. Collective.
  void report(RunReport& report) const;
  /// What is to be known before the answers are believed, a sentence each. Collective.
  std::vector<std::string> warnings() const;
  /// How many of all points diverged. Collective.
  std::size_t diverged() const;

 private:
  void make_block(std::size_t points);
  void answer_together(std::size_t first, std::size_t count);
  void answer_alone(std::size_t point);
  /// Keeps what the method, at this point's parameters, has to say of its answers.
  void doubt(std::size_t point);
  /// Over all points. Collective.
  SolveTotals totals() const;
  bool is_recorded(int step) const { return step % every_ == 0 || step == span_.last_step; }

  const Teuchos::ParameterList& input_;
  Teuchos::RCP<const Communicator> communicator_, own_;
  TimeSpan span_;
  int every_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<TimeScheme> scheme_;
  Method::Reader reader_;              ///< of points one after the other
  std::vector<LocalIndex> places_;     ///< of the probes
  std::size_t together_ = 1;           ///< points that advance together; 1: each has a run of its own
  std::unique_ptr<PointBlock> block_;  ///< of points that advance together; serves one block of points after the other
  std::size_t block_size_ = 0;
  QueryAnswers answers_;
  long long doubtful_ = 0;   ///< this rank's points of whose answers the method has something to say
  std::string first_doubt_;  ///< what it says of the first of these
};

}  // namespace kiln
