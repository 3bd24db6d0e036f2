#include "Chain.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln::test {
namespace {

constexpr int reach = 4;
constexpr int steps[reach] = {-1, 1, -2, 2};
constexpr double weights[reach] = {1.0, 1.0, 0.25, 0.25};

}  // namespace

Specification Chain::specification() {
  Specification s;
  s.integer("count", "particles").at_least(1);
  s.integer("components", "1 or 2").defaults_to(1);
  s.real("diffusion", "of both fields").defaults_to(30.0);
  s.real("reaction", "rate of the cubic sink").defaults_to(2.0);
  s.real("power", "of the source").defaults_to(40.0);
  s.real("velocity", "of the source").defaults_to(5.0);
  return s;
}

void Chain::read(const Teuchos::ParameterList& list) {
  count_ = list.get<int>("count");
  components_ = list.get<int>("components");
  diffusion_ = list.get<double>("diffusion");
  reaction_ = list.get<double>("reaction");
  power_ = list.get<double>("power");
  velocity_ = list.get<double>("velocity");
  list_parameters();
}

void Chain::list_parameters() {
  parameters_.add("diffusion", "1/s", &diffusion_);
  parameters_.add("power", "W", &power_);
  parameters_.add("velocity", "m/s", &velocity_);
}

Chain::Chain(const Teuchos::ParameterList& list, const Context& context) {
  read(list);
  const Map whole(count_, 0, context.communicator);
  std::vector<GlobalIndex> mine;
  for (GlobalIndex id = whole.getMinGlobalIndex(); id <= whole.getMaxGlobalIndex(); ++id) mine.push_back(id);
  build(mine, context.communicator);
}

Chain::Chain(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group) {
  read(list);
  const hdf5::Array<long long> rows = group.integers("rows", {0});
  all_rows_.assign(rows.values.begin(), rows.values.end());
  if (group.has("clusters")) {
    const auto clusters = std::make_shared<Clustered>();
    for (const long long offset : group.integers("offsets").values) clusters->offsets.push_back(offset);
    clusters->sources = group.integers("clusters").values;
    clusters->weights = group.reals("weights").values;
    clusters->positions = group.reals("positions").values;
    clustered_ = clusters;
  }
  const std::size_t rank = context.communicator->getRank(), ranks = context.communicator->getSize();
  build(
      {all_rows_.begin() + all_rows_.size() * rank / ranks, all_rows_.begin() + all_rows_.size() * (rank + 1) / ranks},
      context.communicator);
}

Chain::Chain(const Chain& full, const std::vector<GlobalIndex>& rows, std::shared_ptr<const Clustered> clustered)
    : count_(full.count_),
      components_(full.components_),
      diffusion_(full.diffusion_),
      reaction_(full.reaction_),
      power_(full.power_),
      velocity_(full.velocity_),
      all_rows_(rows),
      clustered_(std::move(clustered)) {
  list_parameters();
  std::sort(all_rows_.begin(), all_rows_.end());
  std::vector<GlobalIndex> mine;
  for (const GlobalIndex id : all_rows_) {
    if (full.rows_->isNodeGlobalElement(id)) mine.push_back(id);
  }
  build(mine, full.rows_->getComm());
}

double Chain::position(GlobalIndex particle) const {
  if (particle >= count_) return clustered_->positions[particle - count_];
  return (static_cast<double>(particle) + 0.5) / count_;
}

std::vector<std::pair<GlobalIndex, double>> Chain::pairs_of(GlobalIndex row) const {
  std::vector<std::pair<GlobalIndex, double>> pairs;
  if (clustered_ != nullptr) {
    const std::size_t place = std::lower_bound(all_rows_.begin(), all_rows_.end(), row) - all_rows_.begin();
    for (std::size_t pair = clustered_->offsets[place]; pair < clustered_->offsets[place + 1]; ++pair) {
      pairs.emplace_back(clustered_->sources[pair], clustered_->weights[pair]);
    }
    return pairs;
  }
  for (int k = 0; k < reach; ++k) {
    const GlobalIndex other = row + steps[k];
    if (other >= 0 && other < count_) pairs.emplace_back(other, weights[k]);
  }
  return pairs;
}

void Chain::build(const std::vector<GlobalIndex>& mine, const Teuchos::RCP<const Communicator>& communicator) {
  std::vector<GlobalIndex> sources = mine;
  std::unordered_set<GlobalIndex> known(mine.begin(), mine.end());
  for (const GlobalIndex id : mine) {
    for (const auto& [other, weight] : pairs_of(id)) {
      if (known.insert(other).second) sources.push_back(other);
    }
  }
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  rows_ = Teuchos::rcp(new Map(unknown, Teuchos::arrayViewFromVector(mine), 0, communicator));
  sources_ = Teuchos::rcp(new Map(unknown, Teuchos::arrayViewFromVector(sources), 0, communicator));
  for (const GlobalIndex id : mine) {
    for (const auto& [other, weight] : pairs_of(id)) {
      neighbours_.push_back(sources_->getLocalElement(other));
      weights_.push_back(weight);
    }
    offsets_.push_back(neighbours_.size());
  }
  positions_ = PositionView("test::positions", sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) positions_(i, 0) = position(sources[i]);
}

std::vector<Field> Chain::fields() const {
  std::vector<Field> result{{"temperature", "K"}, {"second", "1"}};
  result.resize(components_);
  return result;
}

void Chain::initial_state(VectorView u) const {
  for (std::size_t i = 0; i < positions_.extent(0); ++i) {
    u(i * components_) = 0.5 + 0.1 * std::sin(3.0 * positions_(i, 0));
    if (components_ == 2) u(i * components_ + 1) = 0.2;
  }
}

void Chain::rate(ConstVectorView u, double time, VectorView f) const {
  const std::size_t rows = f.extent(0) / components_;
  for (std::size_t i = 0; i < rows; ++i) {
    for (int c = 0; c < components_; ++c) {
      double sum = 0.0;
      for (std::size_t pair = offsets_[i]; pair < offsets_[i + 1]; ++pair) {
        sum += weights_[pair] * (u(neighbours_[pair] * components_ + c) - u(i * components_ + c));
      }
      f(i * components_ + c) = (c == 0 ? 1.0 : 0.5) * diffusion_ * sum;
    }
    const double x = positions_(i, 0), own = u(i * components_);
    const double distance = (x - velocity_ * time) / 0.1;
    f(i * components_) += -reaction_ * own * own * own + power_ * std::exp(-distance * distance);
    if (components_ == 2) {
      f(i * components_) += 0.3 * u(i * components_ + 1);
      f(i * components_ + 1) -= 0.5 * own;
    }
  }
}

void Chain::rate_jacobian_diagonal(ConstVectorView u, double, VectorView diagonal) const {
  const std::size_t rows = diagonal.extent(0) / components_;
  for (std::size_t i = 0; i < rows; ++i) {
    for (int c = 0; c < components_; ++c) {
      double sum = 0.0;
      for (std::size_t pair = offsets_[i]; pair < offsets_[i + 1]; ++pair) sum -= weights_[pair];
      diagonal(i * components_ + c) = (c == 0 ? 1.0 : 0.5) * diffusion_ * sum;
    }
    const double own = u(i * components_);
    diagonal(i * components_) -= 3.0 * reaction_ * own * own;
  }
}

void Chain::apply_rate_jacobian(ConstVectorView u, double, ConstMatrixView v, MatrixView product) const {
  const std::size_t rows = product.extent(0) / components_;
  for (std::size_t column = 0; column < v.extent(1); ++column) {
    for (std::size_t i = 0; i < rows; ++i) {
      for (int c = 0; c < components_; ++c) {
        double sum = 0.0;
        for (std::size_t pair = offsets_[i]; pair < offsets_[i + 1]; ++pair) {
          sum += weights_[pair] * (v(neighbours_[pair] * components_ + c, column) - v(i * components_ + c, column));
        }
        product(i * components_ + c, column) = (c == 0 ? 1.0 : 0.5) * diffusion_ * sum;
      }
      const double own = u(i * components_);
      product(i * components_, column) -= 3.0 * reaction_ * own * own * v(i * components_, column);
      if (components_ == 2) {
        product(i * components_, column) += 0.3 * v(i * components_ + 1, column);
        product(i * components_ + 1, column) -= 0.5 * v(i * components_, column);
      }
    }
  }
}

std::unique_ptr<Model> Chain::sampled(const std::vector<GlobalIndex>& rows) const {
  return std::unique_ptr<Model>(new Chain(*this, rows, nullptr));
}

PairWeights Chain::pair_weights(const std::vector<GlobalIndex>& rows) const {
  PairWeights pairs;
  pairs.rows = rows;
  std::sort(pairs.rows.begin(), pairs.rows.end());
  pairs.offsets.push_back(0);
  for (const GlobalIndex row : pairs.rows) {
    if (row < 0 || row >= count_) throw InputError("", "particle " + std::to_string(row) + " is no row of the chain");
    for (const auto& [source, weight] : pairs_of(row)) {
      pairs.sources.push_back(source);
      pairs.weights.push_back(weight);
    }
    pairs.offsets.push_back(pairs.sources.size());
  }
  return pairs;
}

std::unique_ptr<Model> Chain::clustered(const SourceClusters& clusters) const {
  const auto kept = std::make_shared<Clustered>();
  kept->offsets = clusters.row_offsets;
  kept->weights = clusters.row_weights;
  for (const std::size_t cluster : clusters.row_clusters) {
    kept->sources.push_back(clusters.source_id(cluster, count_));
  }
  kept->positions.resize(clusters.clusters(), 0.0);
  for (std::size_t cluster = 0; cluster < clusters.clusters(); ++cluster) {
    for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
      kept->positions[cluster] += clusters.shares[m] * position(clusters.members[m]);
    }
  }
  return std::unique_ptr<Model>(new Chain(*this, clusters.rows, kept));
}

void Chain::save_sample(hdf5::Group& group) const {
  group.write("rows", std::vector<long long>(all_rows_.begin(), all_rows_.end()));
  if (clustered_ == nullptr) return;
  group.write("offsets", std::vector<long long>(clustered_->offsets.begin(), clustered_->offsets.end()));
  group.write("clusters", std::vector<long long>(clustered_->sources.begin(), clustered_->sources.end()));
  group.write("weights", clustered_->weights);
  group.write("positions", clustered_->positions);
}

KILN_REGISTER(Model, Chain, "test chain", "diffusion, reaction and a moving source on a line; for tests");
KILN_REGISTER(Model, RateOnly, "test rate only", "the same with its rate alone; for tests");

Teuchos::ParameterList input_of(const Case& values) {
  Teuchos::ParameterList input("");
  input.set("title", std::string("test"));
  Teuchos::ParameterList& model = input.sublist("model");
  model.setName("model");
  model.set("type", values.model);
  model.set("count", values.count);
  model.set("components", values.components);
  model.set("diffusion", 30.0);
  model.set("reaction", values.reaction);
  model.set("power", values.power);
  model.set("velocity", 5.0);
  Teuchos::ParameterList& time = input.sublist("time");
  time.setName("time");
  time.set("step", values.step);
  time.set("end", values.step * values.steps);
  time.sublist("scheme").setName("time.scheme");
  time.sublist("scheme").set("type", values.scheme);
  Teuchos::ParameterList& newton = time.sublist("newton");
  newton.setName("time.newton");
  newton.set("tolerance", values.tolerance);
  newton.set("iterations", values.iterations);
  newton.set("jacobian", values.jacobian);
  newton.set("refresh", values.refresh);
  newton.set("line_search", false);
  Teuchos::ParameterList& solver = newton.sublist("linear_solver");
  solver.setName("time.newton.linear_solver");
  solver.set("type", std::string("gmres"));
  solver.set("tolerance", values.linear_tolerance);
  solver.set("iterations", 200);
  solver.set("preconditioner", std::string("none"));
  solver.set("restart", 100);
  input.sublist("method").setName("method");
  input.sublist("method").set("type", values.method);
  input.sublist("method").set("factors", std::string("kept"));
  Teuchos::ParameterList& reduction = input.sublist("reduction");
  reduction.setName("reduction");
  reduction.set("type", std::string("procedure ii"));
  for (const char* name : {"basis", "residual_basis"}) {
    Teuchos::ParameterList& basis = reduction.sublist(name);
    basis.setName(std::string("reduction.") + name);
    basis.set("rank", std::string(name) == "basis" ? values.basis_rank : values.residual_rank);
    basis.set("energy_of", std::string("squared singular values"));
    basis.set("algorithm", values.algorithm);
  }
  Teuchos::ParameterList& sampling = reduction.sublist("sampling");
  sampling.setName("reduction.sampling");
  sampling.set("type", std::string("greedy"));
  sampling.set("samples", values.samples);
  sampling.set("samples_per_mode", 2.0);
  if (!values.clustering.empty()) {
    Teuchos::ParameterList& clustering = reduction.sublist("clustering");
    clustering.setName("reduction.clustering");
    clustering.set("type", values.clustering);
    if (values.clustering == "per row") {
      clustering.set("clusters", values.clusters).set("weights", values.cluster_weights);
    } else if (values.clustering == "among samples") {
      clustering.set("sources", values.clusters).set("ridge", 0.005);
    } else {
      clustering.set("opening", 0.5).set("leaf", 1);
      if (values.clustering == "robust") clustering.set("smooth", 0.0).set("weights", "sums");
    }
  }
  reduction.sublist("snapshots").set("every", values.snapshots_every);
  if (values.snapshots_hold > 0) reduction.sublist("snapshots").set("hold", values.snapshots_hold);
  if (values.windows > 0) reduction.sublist("windows").set("count", values.windows);
  if (values.window_error > 0.0) reduction.sublist("windows").set("error", values.window_error);
  for (const auto& [key, powers] : {std::pair{"train_on", values.train_on}, std::pair{"try_on", values.try_on}}) {
    if (powers.empty()) continue;
    Teuchos::Array<std::string> texts;
    for (const double power : powers) texts.push_back(std::to_string(power));
    reduction.sublist(key).setName(std::string("reduction.") + key);
    reduction.sublist(key).set("grid", false);
    reduction.sublist(key).sublist("points").set("power", texts);
  }
  Teuchos::ParameterList& point = reduction.sublist("queries").sublist("0");
  point.set("position", Teuchos::Array<double>(Teuchos::tuple(1.0, 0.0, 0.0)));
  input.sublist("output").set("directory", values.folder);
  Teuchos::ParameterList& probe = input.sublist("output").sublist("probes").sublist("points").sublist("0");
  probe.set("name", std::string("middle"));
  probe.set("position", Teuchos::Array<double>(Teuchos::tuple(0.49, 0.0, 0.0)));
  return input;
}

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

Teuchos::RCP<const Communicator> self() { return Teuchos::rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)); }

}  // namespace kiln::test
