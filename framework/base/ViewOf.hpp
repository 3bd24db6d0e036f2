#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The values as a view of the default device. `label` names it in a tool's lists of memory.
template <class View, class T>
View view_of(const std::vector<T>& values, const std::string& label) {
  View view(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), values.size());
  const auto host = Kokkos::create_mirror_view(view);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(view, host);
  return view;
}

}  // namespace kiln
