#include "physics/sph/HeatModel.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/Error.hpp"
#include "framework/base/Loop.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/sph/Kernel.hpp"
#include "physics/sph/Material.hpp"
#include "physics/sph/Particles.hpp"
#include "physics/sph/ThermalLanes.hpp"

namespace kiln {
namespace {

// Labels made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string thermal_lanes_label = "kiln::sph::thermal states, eight at a time";
const std::string thermal_states_label = "kiln::sph::thermal states";
const std::string absorbed_label = "kiln::sph::absorbed power";
const std::string rate_label = "kiln::sph::rate";

MaterialTable material_table(const Teuchos::ParameterList& list, const Model::Context& context) {
  const Teuchos::ParameterList& block = list.sublist("material");
  const auto material = Registry<Material>::create(block, {context.communicator});
  const TableRange range = TableRange::of(list);
  return {*material, range.from, range.to, range.step, block.name()};
}

double initial_temperature(const Teuchos::ParameterList& list) {
  const auto temperature = list.get<double>("initial_temperature");
  if (!std::isfinite(temperature)) {
    throw InputError(list.name() + ".initial_temperature", fmt::format("is {}", temperature), "a temperature in K");
  }
  return temperature;
}

HeatDomain domain_of(const Teuchos::ParameterList& list, const Model::Context& context, const MaterialTable& table) {
  const ParticleCloud cloud = Registry<Particles>::create(list.sublist("particles"), {context.communicator})->cloud();
  const double smoothing_length = list.get<double>("smoothing_length") * cloud.spacing;
  const auto kernel = Registry<Kernel>::create(list.sublist("kernel"), {smoothing_length});
  const bool mirrored = list.get<std::string>("boundary") == "mirrored";
  const double density = table.at(initial_temperature(list)).density;
  return whole_domain(cloud, {*kernel, 2.0 * smoothing_length, mirrored, density, list.name()}, context.communicator);
}

}  // namespace

Specification HeatModel::specification() {
  Specification table;
  table.real("from", "lowest temperature; below it, its properties")
      .unit("K")
      .at_least(0)
      .defaults_to(TableRange().from);
  table.real("to", "highest temperature; above it, its properties").unit("K").above(0).defaults_to(TableRange().to);
  table.real("step", "step of the table").unit("K").difference().above(0).defaults_to(TableRange().step);
  table.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    if (list.get<double>("from") >= list.get<double>("to")) {
      problems.push_back(
          {"to", fmt::format("{} K is not above from = {} K", list.get<double>("to"), list.get<double>("from")),
           "a rising range", ""});
    } else if (list.get<double>("step") > list.get<double>("to") - list.get<double>("from")) {
      problems.push_back(
          {"step", fmt::format("{} K is wider than the table", list.get<double>("step")), "at most to - from", ""});
    }
  });

  Specification specification;
  specification.component<Particles>("particles", "where the particles are");
  specification.real("smoothing_length", "h in multiples of the particles' (widest) spacing")
      .above(0)
      .at_most(10)
      .defaults_to(1.5);
  specification.component<Kernel>("kernel", "smoothing kernel, support 2h").defaults_to("cubic spline");
  specification.component<Material>("material", "conductivity, specific heat and density over temperature");
  specification.section("table", "the table the material's properties are interpolated in", std::move(table));
  specification.real("initial_temperature", "temperature at t = 0; its density fixes the masses").unit("K").above(0);
  specification.component<HeatSource>("heat_source", "heat flux into the heated surface");
  specification
      .choice(
          "boundary",
          "as printed: particles beyond the faces are missing; mirrored: insulated ghosts there, for cells that fill "
          "a box",
          {"as printed", "mirrored"})
      .defaults_to("as printed");
  return specification;
}

HeatModel::HeatModel(const Teuchos::ParameterList& list, const MaterialTable& table, HeatDomain domain)
    : list_(list),
      table_(table),
      domain_(std::move(domain)),
      layout_(pair_layout(domain_)),
      initial_temperature_(initial_temperature(list)),
      heat_source_(Registry<HeatSource>::create(list.sublist("heat_source"), {})),
      absorbed_("absorbed power", domain_.areas.extent(0)),
      states_("thermal states", domain_.masses.extent(0) + 1),
      states_of_(domain_.masses.extent(0)),
      fluxes_("pair sums of fluxes", domain_.areas.extent(0)),
      conductances_("pair sums of conductances", domain_.areas.extent(0)) {
  Kokkos::deep_copy(states_, nobody);
  parameters_.add("heat_source", heat_source_->parameters());
  const auto areas = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain_.areas);
  const auto places = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain_.positions);
  std::vector<LocalIndex> heated;
  std::vector<Point> heated_places;
  for (LocalIndex row = 0; row < row_count(); ++row) {
    if (areas(row) == 0.0) continue;
    heated.push_back(row);
    heated_places.push_back({places(row, 0), places(row, 1), places(row, 2)});
  }
  heated_ = IndexView("heated rows", heated.size());
  const auto host = Kokkos::create_mirror_view(heated_);
  std::copy(heated.begin(), heated.end(), host.data());
  Kokkos::deep_copy(heated_, host);
  heated_positions_ = position_view(heated_places);
  heated_flux_ = VectorView("heat flux", heated.size());
}

HeatModel::HeatModel(const Teuchos::ParameterList& list, const Context& context)
    : HeatModel(list, context, material_table(list, context)) {}

HeatModel::HeatModel(const Teuchos::ParameterList& list, const Context& context, const MaterialTable& table)
    : HeatModel(list, table, domain_of(list, context, table)) {
  const int heated = static_cast<int>(heated_.extent(0));
  int most = 0;
  Teuchos::reduceAll(*context.communicator, Teuchos::REDUCE_MAX, 1, &heated, &most);
  if (most == 0 && heat_source_->heats()) {
    const Teuchos::ParameterList& source = list.sublist("heat_source");
    throw InputError(source.name(),
                     fmt::format("a {} heats no particle: none has a heated area", source.get<std::string>("type")),
                     "heated areas, as a column 'area' of a particle file, or heat_source: none");
  }
  adds_absorbed_ = heat_source_->heats();
}

void HeatModel::check(const char* method, std::size_t u, std::size_t f) const {
  if (u == domain_.masses.extent(0) && f == domain_.areas.extent(0)) return;
  throw std::invalid_argument(fmt::format("HeatModel::{}: arrays of {} and {} values; expected {} sources and {} rows",
                                          method, u, f, domain_.masses.extent(0), domain_.areas.extent(0)));
}

void HeatModel::initial_state(VectorView u) const {
  check("initial_state", u.extent(0), domain_.areas.extent(0));
  Kokkos::deep_copy(ExecutionSpace(), u, initial_temperature_);
}

void HeatModel::update_states(const ConstVectorView& of_sources) const {
  if (states_of_.is(of_sources)) return;
  fluxes_hold_ = false;
  const auto u = borrowed(of_sources);
  const auto states = borrowed(states_);
  const auto masses = borrowed(domain_.masses);
  const MaterialLookup table = table_;
  LocalIndex first = 0;
#ifdef KILN_LANES
  const LocalIndex whole = source_count() / lane_count;
  first = whole * lane_count;
  loop(
      thermal_lanes_label, whole, KOKKOS_LAMBDA(LocalIndex group) {
        const LocalIndex j = group * lane_count;
        store_states(&states(j), thermal_lanes(table, lanes_at(&u(j)), lanes_at(&masses(j))));
      });
#endif
  loop(
      thermal_states_label, source_count() - first,
      KOKKOS_LAMBDA(LocalIndex j) { states(first + j) = thermal_state(table, u(first + j), masses(first + j)); });
  states_of_.remember(of_sources);
}

void HeatModel::update_absorbed(double time) const {
  const auto number = static_cast<LocalIndex>(heated_.extent(0));
  if (number == 0 || (time == absorbed_time_ && absorbed_of_.are(heat_source_->parameters()))) return;
  heat_source_->flux(time, heated_positions_, heated_flux_);
  const auto absorbed = borrowed(absorbed_);
  const auto heated = borrowed(heated_);
  const auto flux = borrowed(heated_flux_);
  const auto areas = borrowed(domain_.areas);
  loop(
      absorbed_label, number, KOKKOS_LAMBDA(LocalIndex h) { absorbed(heated(h)) = flux(h) * areas(heated(h)); });
  absorbed_of_.remember(heat_source_->parameters());
  absorbed_time_ = time;
  if (!adds_absorbed_) return;
  absorbed_sum_ += sum(
      absorbed_label, number, KOKKOS_LAMBDA(LocalIndex h) { return absorbed(heated(h)); });
  ++absorbed_times_;
}

std::optional<double> HeatModel::mean_absorbed() const {
  const Communicator& communicator = *domain_.rows->getComm();
  double total = 0.0;
  long long times = 0;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, 1, &absorbed_sum_, &total);
  // A rank without heated rows asks for nothing.
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &absorbed_times_, &times);
  return times == 0 ? std::nullopt : std::optional<double>(total / static_cast<double>(times));
}

void HeatModel::begin_run() {
  absorbed_time_ = std::numeric_limits<double>::quiet_NaN();
  absorbed_sum_ = 0.0;
  absorbed_times_ = 0;
}

std::vector<std::pair<std::string, double>> HeatModel::run_facts() const {
  const std::optional<double> watt = mean_absorbed();
  return watt ? std::vector<std::pair<std::string, double>>{{"mean_absorbed_watt", *watt}}
              : std::vector<std::pair<std::string, double>>{};
}

std::vector<std::string> HeatModel::warnings() const {
  if (mean_absorbed() != 0.0) return {};
  return {
      "the heat source has heated no particle: is it on, does it pass the part, and is it as wide as the particles' "
      "spacing?"};
}

void HeatModel::rate(ConstVectorView u, double time, VectorView of_rows) const {
  check("rate", u.extent(0), of_rows.extent(0));
  update_states(u);
  update_absorbed(time);
  if (!fluxes_hold_) layout_->sum(PairQuantity::flux, states_, fluxes_);
  fluxes_hold_ = true;
  const auto f = borrowed(of_rows);
  const auto states = borrowed(states_);
  const auto sums = borrowed(fluxes_);
  const auto masses = borrowed(domain_.masses);
  const auto absorbed = borrowed(absorbed_);
  loop(
      rate_label, row_count(),
      KOKKOS_LAMBDA(LocalIndex i) { f(i) = heat_rate(states(i), sums(i), masses(i), absorbed(i)); });
}

KILN_REGISTER(Model, HeatModel, "sph heat",
              "heat deposition by smoothed particle hydrodynamics (NRL report, Eqs. 6-20)");

std::vector<std::pair<std::string, double>> HeatModel::facts() const {
  const double mine = static_cast<double>(domain_.pairs.neighbours.extent(0));
  double pairs = 0.0;
  Teuchos::reduceAll(*domain_.rows->getComm(), Teuchos::REDUCE_SUM, 1, &mine, &pairs);
  return {{"pairs", pairs},
          {"neighbours_per_particle", pairs / static_cast<double>(domain_.rows->getGlobalNumElements())}};
}

}  // namespace kiln
