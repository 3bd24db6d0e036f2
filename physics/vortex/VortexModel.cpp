#include "physics/vortex/VortexModel.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <stdexcept>

#include "framework/base/Error.hpp"
#include "framework/base/Pi.hpp"
#include "framework/base/ViewOf.hpp"
#include "framework/model/ParticleMap.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/vortex/PairLoops.hpp"
#include "physics/vortex/Vortices.hpp"

namespace kiln {
namespace {

VortexTable table_of(const Teuchos::ParameterList& list, const Model::Context& context) {
  const Teuchos::ParameterList& particles = list.sublist("particles");
  return whole_table(Registry<Vortices>::create(particles, {context.communicator})->cloud(), particles.name());
}

/// This rank's block of the rows.
std::vector<GlobalIndex> block_of(const std::vector<GlobalIndex>& rows, const Communicator& communicator) {
  const std::size_t rank = communicator.getRank(), ranks = communicator.getSize();
  const auto at = [&rows](std::size_t place) { return rows.begin() + static_cast<std::ptrdiff_t>(place); };
  return {at(rows.size() * rank / ranks), at(rows.size() * (rank + 1) / ranks)};
}

/// This rank's sources: its rows, then the others that act on them, ascending.
std::vector<GlobalIndex> sources_of(const VortexTable& table, const std::vector<GlobalIndex>& own_rows) {
  std::vector<GlobalIndex> acting;
  if (!own_rows.empty() && !table.has_lists()) acting = table.sources;
  for (std::size_t r = 0; r < own_rows.size() && table.has_lists(); ++r) {
    const std::size_t row = table.row(own_rows[r]);
    acting.insert(acting.end(), table.listed.begin() + static_cast<std::ptrdiff_t>(table.offsets[row]),
                  table.listed.begin() + static_cast<std::ptrdiff_t>(table.offsets[row + 1]));
  }
  std::sort(acting.begin(), acting.end());
  acting.erase(std::unique(acting.begin(), acting.end()), acting.end());
  std::vector<GlobalIndex> sources(own_rows);
  std::set_difference(acting.begin(), acting.end(), own_rows.begin(), own_rows.end(), std::back_inserter(sources));
  return sources;
}

std::size_t padded(std::size_t count) {
  constexpr auto multiple = static_cast<std::size_t>(vortex_multiple);
  return (count + multiple - 1) / multiple * multiple;
}

}  // namespace

Specification VortexModel::specification() {
  Specification specification;
  specification.component<Vortices>("particles", "where the vortices are at t = 0, and their circulations");
  specification.component<VortexKernel>("kernel", "regularised Biot-Savart kernel");
  specification.component<VortexSum>("sum", "how the velocity of every vortex at every particle is summed")
      .defaults_to("direct");
  specification.real("circulation_scale", "factor µ on all circulations").defaults_to(1.0);
  return specification;
}

VortexModel::VortexModel(const Teuchos::ParameterList& list, const Teuchos::RCP<const Communicator>& communicator,
                         VortexTable table, const std::vector<GlobalIndex>& own_rows)
    : list_(list),
      table_(std::move(table)),
      row_count_(static_cast<LocalIndex>(own_rows.size())),
      kernel_(Registry<VortexKernel>::create(list.sublist("kernel"), {})),
      sum_(Registry<VortexSum>::create(list.sublist("sum"), {})),
      circulation_scale_(list.get<double>("circulation_scale")) {
  parameters_.add("kernel", kernel_->parameters());
  parameters_.add("circulation_scale", "1", &circulation_scale_);
  const std::vector<GlobalIndex> own_sources = sources_of(table_, own_rows);
  rows_ = map_of(own_rows, communicator);
  sources_ = map_of(own_sources, communicator);
  positions_ = PositionView("kiln::vortex::positions", own_sources.size());
  const auto host = Kokkos::create_mirror_view(positions_);
  for (std::size_t j = 0; j < own_sources.size(); ++j) {
    const std::size_t place = table_.source(own_sources[j]);
    host(j, 0) = table_.x[place];
    host(j, 1) = table_.y[place];
  }
  Kokkos::deep_copy(positions_, host);
  last_state_ = LastState(2 * own_sources.size());
  last_rate_ = VectorView("kiln::vortex::last rate", 2 * own_rows.size());
  if (table_.has_lists()) {
    make_lists(own_rows, own_sources);
  } else {
    make_arrays(own_sources);
  }
}

VortexModel::VortexModel(const Teuchos::ParameterList& list, const Teuchos::RCP<const Communicator>& communicator,
                         VortexTable table)
    : VortexModel(list, communicator, table, block_of(table.rows, *communicator)) {}

VortexModel::VortexModel(const Teuchos::ParameterList& list, const Context& context)
    : VortexModel(list, context.communicator, table_of(list, context)) {}

VortexModel::VortexModel(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group)
    : VortexModel(list, context.communicator, restored_table(group)) {}

void VortexModel::make_arrays(const std::vector<GlobalIndex>& own_sources) {
  if (own_sources.empty()) return;
  const std::size_t count = table_.sources.size();
  array_count_ = static_cast<LocalIndex>(count);
  array_padded_ = static_cast<LocalIndex>(padded(count));
  array_x_ = VectorView("kiln::vortex::x", array_padded_);
  array_y_ = VectorView("kiln::vortex::y", array_padded_);
  std::vector<double> circulations(table_.circulations);
  circulations.resize(padded(count), 0.0);
  array_circulations_ = view_of<VectorView>(circulations, "kiln::vortex::circulations");
  std::vector<LocalIndex> places;
  for (const GlobalIndex id : own_sources) places.push_back(static_cast<LocalIndex>(table_.source(id)));
  places_ = view_of<Indices>(places, "kiln::vortex::places");
}

void VortexModel::make_lists(const std::vector<GlobalIndex>& own_rows, const std::vector<GlobalIndex>& own_sources) {
  const auto local = [&](GlobalIndex id) {
    const auto middle = own_sources.begin() + row_count_;
    auto found = std::lower_bound(own_sources.begin(), middle, id);
    if (found == middle || *found != id) found = std::lower_bound(middle, own_sources.end(), id);
    return static_cast<LocalIndex>(found - own_sources.begin());
  };
  std::vector<std::size_t> offsets{0};
  std::vector<LocalIndex> sources;
  std::vector<double> circulations;
  for (std::size_t r = 0; r < own_rows.size(); ++r) {
    const std::size_t row = table_.row(own_rows[r]);
    for (std::size_t pair = table_.offsets[row]; pair < table_.offsets[row + 1]; ++pair) {
      sources.push_back(2 * local(table_.listed[pair]));
      circulations.push_back(table_.listed_circulations[pair]);
    }
    // The row itself, without circulation, fills the last lanes.
    sources.resize(padded(sources.size()), 2 * static_cast<LocalIndex>(r));
    circulations.resize(sources.size(), 0.0);
    offsets.push_back(sources.size());
  }
  list_offsets_ = view_of<Offsets>(offsets, "kiln::vortex::list offsets");
  list_sources_ = view_of<Indices>(sources, "kiln::vortex::list sources");
  list_circulations_ = view_of<VectorView>(circulations, "kiln::vortex::list circulations");
}

void VortexModel::check(const char* method, std::size_t u, std::size_t f) const {
  const std::size_t sources = 2 * static_cast<std::size_t>(source_count());
  const std::size_t rows = 2 * static_cast<std::size_t>(row_count());
  if (u == sources && f == rows) return;
  throw std::invalid_argument(
      fmt::format("VortexModel::{}: arrays of {} and {} values; expected 2 for each of {} sources and {} rows", method,
                  u, f, source_count(), row_count()));
}

void VortexModel::require_no_lists(const char* method) const {
  if (table_.has_lists()) throw NotOffered("VortexModel on clusters", method);
}

double VortexModel::factor() const { return circulation_scale_ / (2.0 * pi); }

VortexArrays VortexModel::arrays() const {
  return {array_x_.data(), array_y_.data(), array_circulations_.data(), array_count_, array_padded_};
}

VortexLists VortexModel::lists(ConstVectorView u) const {
  return {u.data(), list_offsets_.data(), list_sources_.data(), list_circulations_.data()};
}

void VortexModel::arrange(ConstVectorView u) const {
  const auto x = array_x_, y = array_y_;
  const auto places = places_;
  Kokkos::parallel_for(
      "kiln::vortex::arrange", RangePolicy(0, source_count()), KOKKOS_LAMBDA(LocalIndex j) {
        x(places(j)) = u(2 * j);
        y(places(j)) = u(2 * j + 1);
      });
}

void VortexModel::initial_state(VectorView u) const {
  check("initial_state", u.extent(0), 2 * static_cast<std::size_t>(row_count()));
  const auto positions = positions_;
  Kokkos::parallel_for(
      "kiln::vortex::initial state", RangePolicy(0, source_count()), KOKKOS_LAMBDA(LocalIndex j) {
        u(2 * j) = positions(j, 0);
        u(2 * j + 1) = positions(j, 1);
      });
}

void VortexModel::rate(ConstVectorView u, double, VectorView f) const {
  check("rate", u.extent(0), f.extent(0));
  if (row_count() == 0) return;
  if (last_parameters_.are(parameters_) && last_state_.is(u)) return copy_values(last_rate_, f);
  sum_velocities(u, f);
  copy_values(f, last_rate_);
  last_state_.remember(u);
  last_parameters_.remember(parameters_);
}

void VortexModel::sum_velocities(ConstVectorView u, VectorView f) const {
  if (table_.has_lists()) {
    kernel_->velocities(lists(u), row_count(), factor(), f.data());
    return;
  }
  arrange(u);
  sum_->velocities(*kernel_, arrays(), {u.data(), places_.data(), row_count()}, factor(), f.data());
}

void VortexModel::rate_jacobian_diagonal(ConstVectorView u, double, VectorView diagonal) const {
  check("rate_jacobian_diagonal", u.extent(0), diagonal.extent(0));
  if (row_count() == 0) return;
  if (table_.has_lists()) {
    kernel_->diagonal(lists(u), row_count(), factor(), diagonal.data());
    return;
  }
  arrange(u);
  kernel_->diagonal(arrays(), u.data(), row_count(), factor(), diagonal.data());
}

void VortexModel::apply_rate_jacobian(ConstVectorView u, double, ConstMatrixView v, MatrixView product) const {
  check("apply_rate_jacobian", u.extent(0), product.extent(0));
  check("apply_rate_jacobian", v.extent(0), product.extent(0));
  if (v.extent(1) != product.extent(1)) {
    throw std::invalid_argument("VortexModel::apply_rate_jacobian: v and product differ in their numbers of columns");
  }
  if (row_count() == 0) return;
  const auto columns = static_cast<int>(v.extent(1));
  const Tangents<const double> tangents{v.data(), v.stride_1(), columns};
  const Tangents<double> products{product.data(), product.stride_1(), columns};
  if (table_.has_lists()) {
    kernel_->apply(lists(u), row_count(), tangents, factor(), products);
    return;
  }
  arrange(u);
  if (tangent_x_.extent(1) < v.extent(1)) {
    tangent_x_ = MatrixView("kiln::vortex::tangents in x", array_padded_, columns);
    tangent_y_ = MatrixView("kiln::vortex::tangents in y", array_padded_, columns);
  }
  const auto x = tangent_x_, y = tangent_y_;
  const auto places = places_;
  Kokkos::parallel_for(
      "kiln::vortex::arrange tangents", RangePolicy(0, source_count()), KOKKOS_LAMBDA(LocalIndex j) {
        for (int c = 0; c < columns; ++c) {
          x(places(j), c) = v(2 * j, c);
          y(places(j), c) = v(2 * j + 1, c);
        }
      });
  kernel_->apply(arrays(), {x.data(), y.data(), x.stride_1()}, u.data(), row_count(), tangents, factor(), products);
}

std::unique_ptr<Model> VortexModel::on_table(VortexTable table) const {
  std::vector<GlobalIndex> own_rows;
  for (const GlobalIndex id : table.rows) {
    if (rows_->isNodeGlobalElement(id)) own_rows.push_back(id);
  }
  auto model = std::unique_ptr<VortexModel>(new VortexModel(list_, rows_->getComm(), std::move(table), own_rows));
  for (const Parameter& parameter : parameters_.list()) model->parameters_.set(parameter.name, *parameter.value);
  return model;
}

std::unique_ptr<Model> VortexModel::sampled(const std::vector<GlobalIndex>& rows) const {
  require_no_lists("sampled");
  return on_table(sampled_table(table_, rows));
}

void VortexModel::save_sample(hdf5::Group& group) const { save_table(table_, group); }

PairWeights VortexModel::pair_weights(const std::vector<GlobalIndex>& rows) const {
  require_no_lists("pair_weights");
  return vortex_pair_weights(table_, rows);
}

std::unique_ptr<Model> VortexModel::clustered(const SourceClusters& clusters) const {
  require_no_lists("clustered");
  return on_table(clustered_table(table_, clusters));
}

std::vector<std::pair<std::string, double>> VortexModel::facts() const {
  const double others = static_cast<double>(table_.sources.size()) - 1.0;
  const double pairs =
      table_.has_lists() ? static_cast<double>(table_.listed.size()) : static_cast<double>(table_.rows.size()) * others;
  return {{"pairs", pairs}};
}

KILN_REGISTER(Model, VortexModel, "vortex", "vortex particles in the plane, moved by one another (Biot-Savart)");

}  // namespace kiln
