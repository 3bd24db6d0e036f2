#include "rom/training/FitWeights.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/Collectives.hpp"
#include "framework/model/Model.hpp"
#include "rom/clustering/Points.hpp"
#include "rom/linear_algebra/Dense.hpp"

namespace kiln {
namespace {

/// Rows whose pairs move this much less than those of others are not told from round-off.
constexpr double negligible = 1e-6;
/// A contribution counts as at least this share of the usual size when one is chosen.
constexpr double small = 0.05;

/// The rates of a model in all states: rows × components by states. Pairs know no time, and what else there is
/// cancels.
MatrixView rates(Model& model, const std::vector<const ParticleTable*>& tables, const LearntStates& states) {
  const ParameterPoints own = ParameterPoints::of(model.parameters());
  const std::size_t columns = tables.front()->modes.shape[1] / tables.front()->components;
  const BasisRows basis = rows_at(*model.sources(), tables, columns, "source clustering");
  const VectorView state("kiln::rom::state", basis.reference.extent(0));
  const std::size_t rows = local_size(*model.rows()) * tables.front()->components;
  MatrixView result("kiln::rom::rates in states", rows, states.coordinates.size());
  for (std::size_t k = 0; k < states.coordinates.size(); ++k) {
    Kokkos::deep_copy(state, basis.reference);
    const ConstVectorView known = Kokkos::subview(states.coordinates[k], std::make_pair(std::size_t(0), columns));
    dense::multiply(1.0, basis.modes, known, 1.0, state);
    states.points.set(states.at[k], model.parameters());
    model.rate(state, 0.0, Kokkos::subview(result, Kokkos::ALL, k));
  }
  own.set(0, model.parameters());
  return result;
}

/// Entries of row i of a less those of row j of b, in all states.
std::vector<double> difference(const MatrixView& a, std::size_t i, const MatrixView& b, std::size_t j,
                               std::size_t components) {
  std::vector<double> values;
  for (std::size_t k = 0; k < a.extent(1); ++k) {
    for (std::size_t c = 0; c < components; ++c) {
      values.push_back(a(i * components + c, k) - b(j * components + c, k));
    }
  }
  return values;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

using Contributions = std::vector<std::vector<double>>;

/// Coefficients of `brought` whose sum is `wanted`, drawn to zero by `ridge`, in the unit of what is brought.
VectorView coefficients(const Contributions& brought, const std::vector<double>& wanted, double ridge) {
  const std::size_t count = brought.size();
  MatrixView normal("kiln::rom::normal equations", count, count);
  VectorView result("kiln::rom::coefficients", count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) normal(a, b) = product(brought[a], brought[b]);
    normal(a, a) += ridge * ridge;
    result(a) = product(brought[a], wanted);
  }
  dense::LuFactors factors;
  // The ridge keeps sources apart that bring the same; what is singular nonetheless is not finite.
  if (!(factors.factor(normal) > 0.0)) throw std::logic_error("fit of weights: singular normal equations");
  factors.solve(result);
  return result;
}

/// The contribution along which most of `missing` lies; small ones are counted as if they were larger. Of equal ones
/// the first: particles that a symmetric problem moves alike differ by round-off only.
std::size_t best(const Contributions& brought, const std::vector<bool>& taken, const std::vector<double>& missing,
                 double size) {
  std::size_t found = 0;
  double most = -1.0;
  for (std::size_t c = 0; c < brought.size(); ++c) {
    if (taken[c]) continue;
    const double score =
        std::abs(product(brought[c], missing)) / (std::sqrt(product(brought[c], brought[c])) + small * size);
    if (score > most * (1.0 + clustering_tie)) {
      most = score;
      found = c;
    }
  }
  return found;
}

/// Factors of a row's weights, those of clusters that it does not keep 0.
std::vector<double> chosen(const Contributions& brought, const std::vector<double>& wanted, double size,
                           const WeightFit& fit) {
  std::vector<double> factors(brought.size(), 0.0), missing = wanted;
  // Rows that are all in one state at all moments tell nothing.
  if (size == 0.0) return factors;
  std::vector<bool> taken(brought.size(), false);
  Contributions kept;
  std::vector<std::size_t> places;
  VectorView z;
  const double enough = negligible * negligible * product(wanted, wanted);
  while (kept.size() < std::min(fit.most, brought.size()) && product(missing, missing) > enough) {
    places.push_back(best(brought, taken, missing, size));
    taken[places.back()] = true;
    kept.push_back(brought[places.back()]);
    z = coefficients(kept, wanted, fit.ridge * size);
    missing = wanted;
    for (std::size_t c = 0; c < kept.size(); ++c) {
      for (std::size_t k = 0; k < missing.size(); ++k) missing[k] -= z(c) * kept[c][k];
    }
  }
  for (std::size_t c = 0; c < places.size(); ++c) factors[places[c]] = z(c);
  return factors;
}

std::size_t most_of_a_row(const SourceClusters& clusters) {
  std::size_t most = 0;
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    most = std::max(most, clusters.row_offsets[row + 1] - clusters.row_offsets[row]);
  }
  return most;
}

/// Takes the clusters of weight 0 out of each row's list.
void drop_unweighted(SourceClusters& clusters) {
  std::vector<std::size_t> offsets{0}, kept;
  std::vector<double> weights;
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    for (std::size_t pair = clusters.row_offsets[row]; pair < clusters.row_offsets[row + 1]; ++pair) {
      if (clusters.row_weights[pair] == 0.0) continue;
      kept.push_back(clusters.row_clusters[pair]);
      weights.push_back(clusters.row_weights[pair]);
    }
    offsets.push_back(kept.size());
  }
  clusters.row_offsets = std::move(offsets);
  clusters.row_clusters = std::move(kept);
  clusters.row_weights = std::move(weights);
}

/// What each of this rank's rows misses with all its clusters, and what each of these brings it.
struct RowRates {
  std::size_t row;  ///< place in clusters.rows
  Contributions brought;
  std::vector<double> missed;
};

/// Collective.
std::vector<RowRates> row_rates(const PairwiseModel& pairwise, Model& sample,
                                const std::vector<const ParticleTable*>& tables, const LearntStates& states,
                                const SourceClusters& clusters) {
  const std::unique_ptr<Model> model = pairwise.clustered(clusters);
  const MatrixView all = rates(*model, tables, states), exact = rates(sample, {tables.front()}, states);
  const std::size_t components = tables.front()->components;
  std::vector<RowRates> result(all.extent(0) / components);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const GlobalIndex id = model->rows()->getGlobalElement(static_cast<LocalIndex>(i));
    result[i].row = std::lower_bound(clusters.rows.begin(), clusters.rows.end(), id) - clusters.rows.begin();
    const auto exact_row = static_cast<std::size_t>(sample.rows()->getLocalElement(id));
    result[i].missed = difference(exact, exact_row, all, i, components);
  }
  // Slot s is each row's s-th cluster. Rates are linear in weights: doubled, a cluster shows what it brings.
  for (std::size_t slot = 0; slot < most_of_a_row(clusters); ++slot) {
    SourceClusters changed = clusters;
    for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
      const std::size_t pair = clusters.row_offsets[row] + slot;
      if (pair < clusters.row_offsets[row + 1]) changed.row_weights[pair] *= 2.0;
    }
    const MatrixView doubled = rates(*pairwise.clustered(changed), tables, states);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const std::size_t row = result[i].row;
      if (clusters.row_offsets[row] + slot >= clusters.row_offsets[row + 1]) continue;
      result[i].brought.push_back(difference(doubled, i, all, i, components));
    }
  }
  return result;
}

/// The root of the mean square of what clusters bring.
double size_of(const Contributions& brought) {
  double sum = 0.0;
  for (const std::vector<double>& one : brought) sum += product(one, one);
  return brought.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(brought.size()));
}

}  // namespace

void fit_weights(const PairwiseModel& pairwise, Model& sample, const ParticleTable& members,
                 const ParticleTable& clustered, const LearntStates& states, const WeightFit& fit,
                 SourceClusters& clusters) {
  if (fit.most == 0 && clusters.members.size() == clusters.clusters()) return;
  std::vector<RowRates> rows = row_rates(pairwise, sample, {&members, &clustered}, states, clusters);
  const Communicator& communicator = *sample.rows()->getComm();
  std::vector<double> sizes(clusters.rows.size(), 0.0), factors(clusters.row_weights.size(), 0.0);
  for (const RowRates& of : rows) sizes[of.row] = size_of(of.brought);
  sum_over_ranks(communicator, sizes.data(), sizes.size());
  const double largest = *std::max_element(sizes.begin(), sizes.end());
  for (RowRates& of : rows) {
    double* own = factors.data() + clusters.row_offsets[of.row];
    if (fit.most > 0) {
      for (const std::vector<double>& one : of.brought) {
        for (std::size_t k = 0; k < one.size(); ++k) of.missed[k] += one[k];
      }
      const std::vector<double> z = chosen(of.brought, of.missed, sizes[of.row], fit);
      std::copy(z.begin(), z.end(), own);
      continue;
    }
    std::fill_n(own, of.brought.size(), 1.0);
    if (!(sizes[of.row] > negligible * largest)) continue;
    const VectorView d = coefficients(of.brought, of.missed, fit.ridge * sizes[of.row]);
    for (std::size_t c = 0; c < d.extent(0); ++c) own[c] += d(c);
  }
  sum_over_ranks(communicator, factors.data(), factors.size());
  for (std::size_t pair = 0; pair < factors.size(); ++pair) clusters.row_weights[pair] *= factors[pair];
  if (fit.most > 0) drop_unweighted(clusters);
}

}  // namespace kiln
