#include "rom/training/TrialRun.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/time/TimeScheme.hpp"
#include "rom/training/UnknownRecord.hpp"

namespace kiln {
namespace {

/// `width`: values a step, those of one particle after the other.
void compare_queries(const std::vector<double>& exact, const std::vector<double>& approximate, std::size_t width,
                     const std::vector<Field>& fields, TrialErrors& errors) {
  double worst = 0.0, rise = 0.0, worst_of_free = 0.0, rise_of_free = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double difference = std::abs(approximate[i] - exact[i]);
    const bool is_free = fields[i % fields.size()].origin_is_free;
    const double risen = std::abs(exact[i] - exact[i % width]);
    worst = std::max(worst, difference);
    rise = std::max(rise, risen);
    if (is_free) {
      worst_of_free = std::max(worst_of_free, difference);
      rise_of_free = std::max(rise_of_free, risen);
    } else if (exact[i] != 0.0) {
      errors.worst_query = std::max(errors.worst_query, difference / std::abs(exact[i]));
    }
  }
  if (rise > 0.0) errors.worst_query_of_rise = worst / rise;
  if (rise_of_free > 0.0) errors.worst_query = std::max(errors.worst_query, worst_of_free / rise_of_free);
}

double field_error(const TrialReference& reference, const UnknownRecord& record, PetrovGalerkin& full_size,
                   const Communicator& communicator) {
  const MatrixView exact = reference.states.matrix();
  const VectorView initial("kiln::rom::initial state", exact.extent(0)), state("kiln::rom::state", exact.extent(0));
  const VectorView zero("kiln::rom::zero", local_size(*full_size.coordinates()));
  full_size.initial(zero);
  full_size.state(zero, initial);
  double sums[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < record.unknowns().size(); ++k) {
    full_size.begin_step(record.times()[k]);
    full_size.state(record.unknowns()[k], state);
    for (std::size_t i = 0; i < state.extent(0); ++i) {
      const double difference = state(i) - initial(i) - exact(i, k);
      sums[0] += difference * difference;
      sums[1] += exact(i, k) * exact(i, k);
    }
  }
  sum_over_ranks(communicator, sums, 2);
  return sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}

}  // namespace

QueryRecord::QueryRecord(Method& method, const std::vector<GlobalIndex>& ids)
    : communicator_(method.particles()->getComm()) {
  const Map& map = *method.particles();
  const std::size_t components = method.fields().size(), particles = local_size(map);
  width_ = ids.size() * components;
  std::vector<LocalIndex> places;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const LocalIndex place = map.getLocalElement(ids[i]);
    if (place < 0 || place >= static_cast<LocalIndex>(particles)) continue;
    places.push_back(place);
    for (std::size_t c = 0; c < components; ++c) columns_.push_back(i * components + c);
  }
  reader_ = method.reader(places);
  read_ = VectorView("kiln::rom::queried", columns_.size());
}

void QueryRecord::observe(const Moment& moment) {
  reader_(moment.x, read_);
  const std::size_t row = values_.size();
  values_.resize(row + width_, 0.0);
  for (std::size_t i = 0; i < columns_.size(); ++i) values_[row + columns_[i]] = read_(i);
}

std::vector<double> QueryRecord::values() const {
  std::vector<double> all = values_;
  sum_over_ranks(*communicator_, all.data(), all.size());
  return all;
}

nlohmann::json TrialErrors::facts() const {
  if (diverged) return {{"diverged", true}};
  return {{"diverged", false},
          {"worst_query_error", worst_query},
          {"worst_query_error_of_rise", worst_query_of_rise},
          {"field_l2_error", field},
          {"iterations_per_step", iterations_per_step},
          {"capped_steps", capped_steps}};
}

TrialErrors TrialErrors::worse(const TrialErrors& other) const {
  return {std::max(worst_query, other.worst_query),
          std::max(worst_query_of_rise, other.worst_query_of_rise),
          std::max(field, other.field),
          std::max(iterations_per_step, other.iterations_per_step),
          std::max(capped_steps, other.capped_steps),
          diverged || other.diverged};
}

TrialErrors trial_run(const std::string& type, const Teuchos::ParameterList& input, const std::filesystem::path& file,
                      const TimeSpan& span, const TrialReference& reference, PetrovGalerkin& full_size,
                      const Teuchos::RCP<const Communicator>& communicator) {
  Teuchos::ParameterList online(input);
  online.remove("method");
  online.sublist("method").set("type", type).set("file", file.string());
  online.sublist("method").set<std::string>("factors", "kept");
  const std::unique_ptr<Method> method =
      Registry<Method>::create(online.sublist("method"), Method::Context{online, communicator});
  if (reference.point.count() > 0) reference.point.set(0, method->parameters());
  const std::unique_ptr<TimeScheme> scheme =
      Registry<TimeScheme>::create(online.sublist("time").sublist("scheme"), TimeScheme::Context{*method, span.step});
  VectorView x("kiln::rom::unknown", local_size(*method->coordinates()));
  method->initial(x);
  scheme->start(x, 0.0);
  QueryRecord queries(*method, reference.queries);
  UnknownRecord unknowns(reference.steps);

  TrialErrors errors;
  try {
    const LoopTotals totals = run_time_loop(*method, *scheme, x, span, {&queries, &unknowns});
    errors.iterations_per_step = static_cast<double>(totals.iterations) / std::max(1LL, totals.steps);
    errors.capped_steps = totals.capped_steps;
  } catch (const DivergenceError&) {
    errors.diverged = true;
    return errors;
  }
  const std::size_t width = reference.queries.size() * method->fields().size();
  if (width > 0) compare_queries(reference.query_values, queries.values(), width, method->fields(), errors);
  errors.field = field_error(reference, unknowns, full_size, *communicator);
  return errors;
}

}  // namespace kiln
