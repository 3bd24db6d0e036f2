#include "framework/driver/QueryRun.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/base/Memory.hpp"
#include "framework/base/StopRequest.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"
#include "framework/observers/Probes.hpp"
#include "framework/queries/QueryPoints.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

const Teuchos::ParameterList& probe_block(const Teuchos::ParameterList& input) {
  const Teuchos::ParameterList& output = input.sublist("output");
  if (!output.isSublist("probes")) {
    throw InputError("output", "there are no probes, whose histories answer the queries", "a block output.probes");
  }
  return output.sublist("probes");
}

/// Keeps what a run of one point shows.
class Recorder final : public StepListener {
 public:
  using Keep = std::function<void(int step, ConstVectorView x)>;
  Recorder(PointOutcome& outcome, Keep keep) : outcome_(outcome), keep_(std::move(keep)) {}
  void observe(const Moment& moment) override {
    if (moment.step > 0) outcome_.add(moment.solve);
    keep_(moment.step, moment.x);
  }

 private:
  PointOutcome& outcome_;
  Keep keep_;
};

}  // namespace

QueryRun::QueryRun(const Teuchos::ParameterList& input, Teuchos::RCP<const Communicator> communicator)
    : input_(input),
      communicator_(std::move(communicator)),
      own_(communicator_->split(communicator_->getRank(), 0)),
      span_(TimeSpan::of(input)),
      every_(probe_block(input).get<int>("every")) {
  method_ = Registry<Method>::create(input_.sublist("method"), {input_, own_});
  scheme_ = Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"), {*method_, span_.step});
  const Teuchos::ParameterList& queries = input.sublist("queries");
  answers_.points = points_of(queries, method_->parameters());
  for (const std::string& name : answers_.points.names) {
    const auto& list = method_->parameters().list();
    const auto named = [&name](const Parameter& parameter) { return parameter.name == name; };
    answers_.units.push_back(std::find_if(list.begin(), list.end(), named)->unit);
  }
  for (const Probe& probe : find_probes(probe_block(input), *method_)) {
    answers_.probes.push_back(probe.name);
    places_.push_back(probe.particle.local);
  }
  answers_.fields = method_->fields();
  const double numbers = static_cast<double>(answers_.points.count()) * static_cast<double>(places_.size()) *
                         (static_cast<double>(span_.last_step) / every_ + 1.0);
  if (numbers * sizeof(double) > machine_memory()) {
    throw InputError(
        "queries",
        fmt::format("{} points and {} probes give {:.3g} numbers", answers_.points.count(), places_.size(), numbers),
        "what this machine's memory holds; raise output.probes.every");
  }
  for (int step = 0; step <= span_.last_step; ++step) {
    if (!is_recorded(step)) continue;
    answers_.steps.push_back(step);
    answers_.times.push_back(step * span_.step);
  }

  const std::size_t count = answers_.points.count(), wanted = queries.get<int>("together");
  if (dynamic_cast<AdvancesTogether*>(method_.get()) != nullptr) together_ = std::min(wanted, count);
  if (together_ > 1) make_block(1);
  const std::size_t blocks = (count + together_ - 1) / together_;
  const std::size_t rank = communicator_->getRank(), ranks = communicator_->getSize();
  answers_.first = std::min(count, blocks * rank / ranks * together_);
  answers_.outcomes.resize(std::min(count, blocks * (rank + 1) / ranks * together_) - answers_.first);
}

void QueryRun::make_block(std::size_t points) {
  block_ = dynamic_cast<AdvancesTogether&>(*method_).point_block({points, *scheme_, span_.step, places_});
  block_size_ = points;
}

void QueryRun::answer_together(std::size_t first, std::size_t count) {
  const bool is_last = first + count == answers_.outcomes.size();
  if (block_size_ != count) make_block(count);
  const MatrixView told("kiln::queries::probes", count, answers_.width());
  std::size_t recorded = 0;
  const auto record = [&](int step) {
    if (!is_recorded(step)) return;
    block_->tell(told);
    for (std::size_t point = 0; point < count; ++point) {
      if (!block_->outcomes()[point].divergence.empty()) continue;
      double* row = answers_.row(first + point, recorded);
      for (std::size_t column = 0; column < answers_.width(); ++column) row[column] = told(point, column);
    }
    ++recorded;
  };
  StopRequest stop(*own_, 0);
  block_->start(answers_.points.part(answers_.first + first, count));
  record(0);
  for (int step = 1; step <= span_.last_step; ++step) {
    block_->advance(step, step * span_.step);
    record(step);
    if (stop.came(step) && !(is_last && step == span_.last_step)) throw Stopped(StopRequest::name());
  }
  std::copy(block_->outcomes().begin(), block_->outcomes().end(),
            answers_.outcomes.begin() + static_cast<std::ptrdiff_t>(first));
  for (std::size_t point = answers_.first + first; point < answers_.first + first + count; ++point) {
    answers_.points.set(point, method_->parameters());
    doubt(point);
  }
}

void QueryRun::answer_alone(std::size_t point) {
  // What a method has frozen in one run must not reach the next.
  method_->forget();
  answers_.points.set(answers_.first + point, method_->parameters());
  if (reader_ == nullptr) reader_ = method_->reader(places_);
  const VectorView told("kiln::queries::probes", answers_.width());
  const VectorView x("kiln::queries::unknown", local_size(*method_->coordinates()));
  std::size_t recorded = 0;
  PointOutcome& outcome = answers_.outcomes[point];
  Recorder recorder(outcome, [&](int step, ConstVectorView unknown) {
    if (!is_recorded(step)) return;
    reader_(unknown, told);
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), told);
    std::copy_n(host.data(), host.extent(0), answers_.row(point, recorded++));
  });
  try {
    method_->initial(x);
    scheme_->start(x, 0.0);
    run_time_loop(*method_, *scheme_, x, span_, {&recorder});
  } catch (const DivergenceError& error) {
    outcome.divergence = error.what();
  }
  doubt(answers_.first + point);
}

void QueryRun::doubt(std::size_t point) {
  const std::vector<std::string> warnings = method_->warnings();
  if (warnings.empty()) return;
  if (doubtful_++ == 0) first_doubt_ = fmt::format("point {}: {}", point, fmt::join(warnings, "; "));
}

const QueryAnswers& QueryRun::answer() {
  const std::size_t count = answers_.outcomes.size();
  answers_.histories.assign(count * answers_.steps.size() * answers_.width(), std::numeric_limits<double>::quiet_NaN());
  answers_.outcomes.assign(count, {});
  std::string refused, stopped;
  try {
    for (std::size_t first = 0; first < count; first += together_) {
      if (together_ > 1) {
        answer_together(first, std::min(together_, count - first));
      } else {
        answer_alone(first);
      }
    }
  } catch (const Stopped&) {
    stopped = StopRequest::name();
  } catch (const InputError& error) {
    refused = error.what();
  } catch (const NotOffered& error) {
    refused = error.what();
  }
  for (const std::string& name : gathered(*communicator_, stopped)) {
    if (!name.empty()) throw Stopped(name + " came: stopped before all points were answered; no answer is kept");
  }
  for (const std::string& text : gathered(*communicator_, refused)) {
    if (!text.empty()) throw InputError("queries", text);
  }
  return answers_;
}

std::size_t QueryRun::diverged() const {
  const auto is_marked = [](const PointOutcome& outcome) { return !outcome.divergence.empty(); };
  const long long mine = std::count_if(answers_.outcomes.begin(), answers_.outcomes.end(), is_marked);
  long long all = 0;
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_SUM, 1, &mine, &all);
  return static_cast<std::size_t>(all);
}

void QueryRun::report(RunReport& report) const {
  nlohmann::json marked = nlohmann::json::array();
  for (std::size_t i = 0; i < answers_.outcomes.size(); ++i) {
    const PointOutcome& outcome = answers_.outcomes[i];
    if (!outcome.divergence.empty()) marked.push_back({{"point", answers_.first + i}, {"what", outcome.divergence}});
  }
  nlohmann::json divergences = nlohmann::json::array();
  for (const std::string& text : gathered(*communicator_, json_text(marked))) {
    for (const nlohmann::json& one : nlohmann::json::parse(text)) divergences.push_back(one);
  }
  report.section("queries") = {{"points", answers_.points.count()},
                               {"together", together_},
                               {"diverged", divergences.size()},
                               {"divergences", divergences}};
  report.section("solve") = totals().facts();
  method_->report(report.section("method"));
}

SolveTotals QueryRun::totals() const {
  SolveTotals mine, all;
  for (const PointOutcome& outcome : answers_.outcomes) mine += outcome;
  const long long counted[] = {mine.steps, mine.residuals, mine.iterations, mine.capped_steps};
  long long sums[4] = {};
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_SUM, 4, counted, sums);
  all.steps = sums[0];
  all.residuals = sums[1];
  all.iterations = sums[2];
  all.capped_steps = sums[3];
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MAX, 1, &mine.most_left, &all.most_left);
  return all;
}

std::vector<std::string> QueryRun::warnings() const {
  std::vector<std::string> warnings = totals().warnings();
  long long points = 0;
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_SUM, 1, &doubtful_, &points);
  for (const std::string& first : gathered(*communicator_, first_doubt_)) {
    if (first.empty()) continue;
    warnings.push_back(first);
    if (points > 1) warnings.back() += fmt::format("; and {} more point{}", points - 1, points == 2 ? "" : "s");
    break;
  }
  return warnings;
}

}  // namespace kiln
