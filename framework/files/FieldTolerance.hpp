#pragma once

#include <string>
#include <vector>

namespace kiln {

/// How far fields of some names may differ: |a − b| ≤ tolerance · max(|a|, |b|, floor).
struct FieldTolerance {
  std::string fields;  ///< a field's name as comparisons print it; each '*' stands for any text
  double tolerance = 0.0;
  double floor = 0.0;  ///< in the field's own unit

  bool matches(const std::string& field) const;
};

/// Reads "FIELDS=TOLERANCE" or "FIELDS=TOLERANCE,FLOOR", e.g. "probes.csv:* temperature [K]=1e-8,1". Throws
/// InputError for anything but finite numbers of at least 0.
FieldTolerance field_tolerance(const std::string& text);

}  // namespace kiln
