#pragma once

#include <fmt/format.h>

#include <Teuchos_ParameterList.hpp>

#include "physics/vortex/PairLoops.hpp"
#include "physics/vortex/VortexKernel.hpp"

namespace kiln {

/// The sums of a VortexKernel for a law of KernelLaws.hpp: each loop is compiled for the law, so that it vectorises. A
/// kernel of one's own derives from this and says its law, or from CoreKernel when δ is all it needs.
template <class Law>
class VortexKernelOf : public VortexKernel {
 public:
  void velocities(const VortexArrays& vortices, const double* targets, LocalIndex count, double factor,
                  double* velocities) const override {
    const Law q = law();
    constexpr LocalIndex block = 4;
    Kokkos::parallel_for(
        "kiln::vortex::velocities", RangePolicy(0, (count + block - 1) / block), KOKKOS_LAMBDA(LocalIndex b) {
          double points[2 * block], sums[2 * block];
          const LocalIndex first = b * block;
          for (LocalIndex t = 0; t < block; ++t) {
            // A block that is not full repeats its last target.
            const LocalIndex target = first + t < count ? first + t : count - 1;
            points[2 * t] = targets[2 * target];
            points[2 * t + 1] = targets[2 * target + 1];
          }
          sum_at_four<VortexScalar>(q, vortices, points, sums);
          for (LocalIndex t = 0; t < block && first + t < count; ++t) {
            velocities[2 * (first + t)] = factor * sums[2 * t];
            velocities[2 * (first + t) + 1] = factor * sums[2 * t + 1];
          }
        });
  }

  void velocities(const VortexLists& lists, LocalIndex count, double factor, double* velocities) const override {
    const Law q = law();
    Kokkos::parallel_for(
        "kiln::vortex::velocities of lists", RangePolicy(0, count), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t first = lists.offsets[i];
          double sum[2];
          sum_over_list<VortexScalar>(q, lists.points, lists.sources + first, lists.circulations + first,
                                      static_cast<LocalIndex>(lists.offsets[i + 1] - first), lists.points[2 * i],
                                      lists.points[2 * i + 1], sum);
          velocities[2 * i] = factor * sum[0];
          velocities[2 * i + 1] = factor * sum[1];
        });
  }

  void diagonal(const VortexArrays& vortices, const double* targets, LocalIndex count, double factor,
                double* diagonal) const override {
    const Law q = law();
    const ArrayReader reader{vortices, {}};
    Kokkos::parallel_for(
        "kiln::vortex::jacobian diagonal", RangePolicy(0, count), KOKKOS_LAMBDA(LocalIndex i) {
          const double shear = factor * shear_at<VortexScalar>(q, reader, targets[2 * i], targets[2 * i + 1]);
          diagonal[2 * i] = -shear;
          diagonal[2 * i + 1] = shear;
        });
  }

  void diagonal(const VortexLists& lists, LocalIndex count, double factor, double* diagonal) const override {
    const Law q = law();
    Kokkos::parallel_for(
        "kiln::vortex::jacobian diagonal of lists", RangePolicy(0, count), KOKKOS_LAMBDA(LocalIndex i) {
          const double shear =
              factor * shear_at<VortexScalar>(q, reader_of(lists, i, {}), lists.points[2 * i], lists.points[2 * i + 1]);
          diagonal[2 * i] = -shear;
          diagonal[2 * i + 1] = shear;
        });
  }

  void apply(const VortexArrays& vortices, const TangentArrays& sources, const double* targets, LocalIndex count,
             const Tangents<const double>& own, double factor, const Tangents<double>& products) const override {
    const Law q = law();
    const auto reader = KOKKOS_LAMBDA(LocalIndex, int column) {
      const std::size_t skipped = column * sources.stride;
      return ArrayReader{vortices, {sources.x + skipped, sources.y + skipped, sources.stride}};
    };
    by_widths(own.columns, [&](auto width, int column) {
      apply_columns<decltype(width)::value>("kiln::vortex::apply jacobian", q, reader, targets, count, column, own,
                                            factor, products);
    });
  }

  void apply(const VortexLists& lists, LocalIndex count, const Tangents<const double>& tangents, double factor,
             const Tangents<double>& products) const override {
    const Law q = law();
    const auto reader = KOKKOS_LAMBDA(LocalIndex i, int column) {
      return reader_of(lists, i, {tangents.values + column * tangents.stride, tangents.stride, tangents.columns});
    };
    by_widths(tangents.columns, [&](auto width, int column) {
      apply_columns<decltype(width)::value>("kiln::vortex::apply jacobian of lists", q, reader, lists.points, count,
                                            column, tangents, factor, products);
    });
  }

  /// Columns `column` … column + Width − 1. `reader(i, column)` gives the vortices that act on target i. Public, since
  /// CUDA wants functions with kernels so.
  template <int Width, class Reader>
  static void apply_columns(const char* label, const Law& q, const Reader& reader, const double* targets,
                            LocalIndex count, int column, const Tangents<const double>& own, double factor,
                            const Tangents<double>& products) {
    Kokkos::parallel_for(
        label, RangePolicy(0, count), KOKKOS_LAMBDA(LocalIndex i) {
          double tangents[2 * Width], sums[2 * Width];
          for (int c = 0; c < Width; ++c) {
            const double* values = own.values + (column + c) * own.stride + 2 * i;
            tangents[2 * c] = values[0];
            tangents[2 * c + 1] = values[1];
          }
          tangents_at<VortexScalar, Width>(q, reader(i, column), targets[2 * i], targets[2 * i + 1], tangents, sums);
          for (int c = 0; c < Width; ++c) {
            double* values = products.values + (column + c) * products.stride + 2 * i;
            values[0] = factor * sums[2 * c];
            values[1] = factor * sums[2 * c + 1];
          }
        });
  }

 protected:
  /// With the live parameters' present values. Throws InputError for a value that makes no sense.
  virtual Law law() const = 0;

 private:
  KOKKOS_INLINE_FUNCTION static ListReader reader_of(const VortexLists& lists, LocalIndex i,
                                                     const Tangents<const double>& tangents) {
    const std::size_t first = lists.offsets[i];
    return {lists.points, lists.sources + first, lists.circulations + first,
            static_cast<LocalIndex>(lists.offsets[i + 1] - first), tangents};
  }

  /// Calls work(std::integral_constant<int, width>, first column) for all columns, four at a time and the rest singly.
  template <class Work>
  static void by_widths(int columns, const Work& work) {
    int column = 0;
    for (; column + 4 <= columns; column += 4) work(std::integral_constant<int, 4>(), column);
    for (; column < columns; ++column) work(std::integral_constant<int, 1>(), column);
  }
};

/// A kernel whose law is made from its core radius δ, a live parameter.
template <class Law>
class CoreKernel : public VortexKernelOf<Law> {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("core_radius", "δ: below it the velocity of a vortex falls to zero").unit("m").above(0);
    return specification;
  }

  CoreKernel(const Teuchos::ParameterList& list, const NoContext&) : core_radius_(list.get<double>("core_radius")) {
    this->parameters_.add("core_radius", "m", &core_radius_, Allowed::positive);
  }

 protected:
  Law law() const override { return Law(core_radius_); }

 private:
  double core_radius_;
};

}  // namespace kiln
