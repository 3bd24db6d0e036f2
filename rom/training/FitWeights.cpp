#include "rom/training/FitWeights.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>

#include "framework/model/Model.hpp"
#include "rom/files/ReductionFile.hpp"
#include "rom/linear_algebra/Dense.hpp"

namespace kiln {
namespace {

constexpr double ridge = 0.1;
/// Rows whose pairs move this much less than those of others are not told from round-off.
constexpr double negligible = 1e-6;

/// The rates of a model at all moments: rows × components by moments. Pairs know no time, and what else there is
/// cancels.
MatrixView rates(const Model& model, const std::vector<const ParticleTable*>& tables,
                 const std::vector<VectorView>& moments) {
  const std::size_t columns = tables.front()->modes.shape[1] / tables.front()->components;
  const ReductionFile::Rows basis = rows_at(*model.sources(), tables, columns, "source clustering");
  const VectorView state("kiln::rom::state", basis.reference.extent(0));
  const std::size_t rows = model.rows()->getMyGlobalIndices().extent(0) * tables.front()->components;
  MatrixView result("kiln::rom::rates at moments", rows, moments.size());
  for (std::size_t moment = 0; moment < moments.size(); ++moment) {
    Kokkos::deep_copy(state, basis.reference);
    const ConstVectorView known = Kokkos::subview(moments[moment], std::make_pair(std::size_t(0), columns));
    dense::multiply(1.0, basis.modes, known, 1.0, state);
    model.rate(state, 0.0, Kokkos::subview(result, Kokkos::ALL, moment));
  }
  return result;
}

/// Entries of row i of a less those of row j of b, at all moments.
std::vector<double> difference(const MatrixView& a, std::size_t i, const MatrixView& b, std::size_t j,
                               std::size_t components) {
  std::vector<double> values;
  for (std::size_t moment = 0; moment < a.extent(1); ++moment) {
    for (std::size_t c = 0; c < components; ++c) {
      values.push_back(a(i * components + c, moment) - b(j * components + c, moment));
    }
  }
  return values;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// d of one row, from what each cluster brings to its rate and what the clusters together miss.
VectorView fitted(const std::vector<std::vector<double>>& brought, const std::vector<double>& missed, double size) {
  const std::size_t count = brought.size();
  MatrixView normal("kiln::rom::normal equations", count, count);
  VectorView d("kiln::rom::changes of weights", count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) normal(a, b) = product(brought[a], brought[b]);
    normal(a, a) += ridge * ridge * size * size;
    d(a) = product(brought[a], missed);
  }
  dense::LuFactors factors;
  factors.factor(normal);
  factors.solve(d);
  return d;
}

std::size_t most_of_a_row(const SourceClusters& clusters) {
  std::size_t most = 0;
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    most = std::max(most, clusters.row_offsets[row + 1] - clusters.row_offsets[row]);
  }
  return most;
}

}  // namespace

void fit_weights(const PairwiseModel& pairwise, const Model& sample, const ParticleTable& members,
                 const ParticleTable& clustered, const std::vector<VectorView>& moments, SourceClusters& clusters) {
  if (clusters.members.size() == clusters.clusters()) return;
  const std::vector<const ParticleTable*> tables{&members, &clustered};
  const std::unique_ptr<Model> model = pairwise.clustered(clusters);
  const MatrixView all = rates(*model, tables, moments), exact = rates(sample, {&members}, moments);
  // Slot s is each row's s-th cluster. Rates are linear in weights: doubled, a cluster shows what it brings.
  std::vector<MatrixView> doubled;
  for (std::size_t slot = 0; slot < most_of_a_row(clusters); ++slot) {
    SourceClusters changed = clusters;
    for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
      const std::size_t pair = clusters.row_offsets[row] + slot;
      if (pair < clusters.row_offsets[row + 1]) changed.row_weights[pair] *= 2.0;
    }
    doubled.push_back(rates(*pairwise.clustered(changed), tables, moments));
  }

  const std::size_t components = members.components;
  const Map& rows = *model->rows();
  const Communicator& communicator = *rows.getComm();
  std::vector<std::size_t> places;
  std::vector<std::vector<std::vector<double>>> brought;
  std::vector<double> sizes(clusters.rows.size(), 0.0), changes(clusters.row_weights.size(), 0.0);
  for (std::size_t i = 0; i < all.extent(0) / components; ++i) {
    const GlobalIndex id = rows.getGlobalElement(static_cast<LocalIndex>(i));
    const std::size_t row = std::lower_bound(clusters.rows.begin(), clusters.rows.end(), id) - clusters.rows.begin();
    places.push_back(row);
    brought.emplace_back();
    const std::size_t count = clusters.row_offsets[row + 1] - clusters.row_offsets[row];
    for (std::size_t slot = 0; slot < count; ++slot) {
      brought.back().push_back(difference(doubled[slot], i, all, i, components));
      sizes[row] += product(brought.back().back(), brought.back().back()) / static_cast<double>(count);
    }
    sizes[row] = std::sqrt(sizes[row]);
  }
  dense::sum_over_ranks(communicator, sizes.data(), sizes.size());
  const double largest = *std::max_element(sizes.begin(), sizes.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = places[i];
    if (!(sizes[row] > negligible * largest)) continue;
    const auto exact_row = static_cast<std::size_t>(sample.rows()->getLocalElement(clusters.rows[row]));
    const std::vector<double> missed = difference(exact, exact_row, all, i, components);
    const VectorView d = fitted(brought[i], missed, sizes[row]);
    std::copy_n(d.data(), d.extent(0), changes.data() + clusters.row_offsets[row]);
  }
  dense::sum_over_ranks(communicator, changes.data(), changes.size());
  for (std::size_t pair = 0; pair < changes.size(); ++pair) clusters.row_weights[pair] *= 1.0 + changes[pair];
}

}  // namespace kiln
