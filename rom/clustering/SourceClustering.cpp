#include "rom/clustering/SourceClustering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kiln {
namespace {

constexpr const char* sums = "sums";
constexpr const char* fitted = "fitted";

}  // namespace

void WeightFit::specify(Specification& specification, const char* if_left_out) {
  specification
      .choice("weights",
              "of clusters. sums: of their members' weights; fitted: near these, such that the rates of the training "
              "come out right in the mean",
              {sums, fitted})
      .defaults_to(if_left_out);
}

std::optional<WeightFit> WeightFit::of(const Teuchos::ParameterList& list) {
  return list.get<std::string>("weights") == fitted ? std::optional(near_sums()) : std::nullopt;
}

std::size_t SourceMotion::place(GlobalIndex id) const {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found == ids.end() || *found != id) throw std::logic_error(fmt::format("no motion of particle {} is known", id));
  return static_cast<std::size_t>(found - ids.begin());
}

}  // namespace kiln
