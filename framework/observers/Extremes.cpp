#include "framework/observers/Extremes.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <limits>

#include "framework/registry/Registry.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {

KILN_REGISTER(Observer, Extremes, "extremes", "highest and lowest value of each component, into the report");

Specification Extremes::specification() {
  Specification specification;
  specification.integer("every", "steps between two looks").at_least(1).defaults_to(10);
  return specification;
}

Extremes::Extremes(const Teuchos::ParameterList& list, const Context& context)
    : method_(context.method),
      communicator_(context.communicator),
      every_(list.get<int>("every")),
      state_("kiln::extremes::state", local_size(*context.method.particles()) * context.method.fields().size()),
      largest_(context.method.fields().size(), {-std::numeric_limits<double>::infinity()}),
      smallest_(context.method.fields().size(), {std::numeric_limits<double>::infinity()}) {}

void Extremes::observe(const Moment& moment) {
  if (moment.step % every_ != 0 && moment.step != moment.last_step) return;
  method_.state(moment.x, state_);
  const auto state = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_);
  const std::size_t components = largest_.size();
  for (std::size_t index = 0; index < state.extent(0); ++index) {
    Extreme& largest = largest_[index % components];
    Extreme& smallest = smallest_[index % components];
    const double value = state(index);
    if (value <= largest.value && value >= smallest.value) continue;
    const auto particle = method_.particles()->getGlobalElement(static_cast<LocalIndex>(index / components));
    if (value > largest.value) largest = {value, moment.time, particle};
    if (value < smallest.value) smallest = {value, moment.time, particle};
  }
}

void Extremes::finish(RunReport& report) {
  const std::vector<Field> fields = method_.fields();
  const auto over_ranks = [&](const Extreme& mine, double sign) {
    double best = 0.0;
    const double signed_value = sign * mine.value;
    Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MAX, 1, &signed_value, &best);
    // Of the ranks that hold the extreme value, the one with the lowest particle id speaks.
    const GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
    const GlobalIndex candidate = signed_value == best && mine.particle >= 0 ? mine.particle : none;
    GlobalIndex particle = none;
    Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MIN, 1, &candidate, &particle);
    const double my_time = candidate == particle && particle != none ? mine.time : 0.0;
    double time = 0.0;
    Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MAX, 1, &my_time, &time);
    return nlohmann::json{{"value", sign * best}, {"time_s", time}, {"particle", particle}};
  };
  nlohmann::json& section = report.section("observers")["extremes"];
  for (std::size_t component = 0; component < fields.size(); ++component) {
    const nlohmann::json largest = over_ranks(largest_[component], 1.0);
    const nlohmann::json smallest = over_ranks(smallest_[component], -1.0);
    section[fields[component].name] = {{"unit", fields[component].unit},
                                       {"largest", largest["value"]},
                                       {"largest_time_s", largest["time_s"]},
                                       {"largest_particle", largest["particle"]},
                                       {"smallest", smallest["value"]},
                                       {"smallest_time_s", smallest["time_s"]},
                                       {"smallest_particle", smallest["particle"]}};
  }
}

}  // namespace kiln
