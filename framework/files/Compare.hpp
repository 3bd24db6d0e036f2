#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/files/FieldTolerance.hpp"

namespace kiln {

/// How one field (a dataset, a CSV column, a JSON number) of two results differs.
struct FieldDifference {
  std::string field;
  double tolerance = 0.0, floor = 0.0;
  std::size_t compared = 0;  ///< numbers
  std::size_t failed = 0;    ///< numbers beyond the tolerance
  double worst = 0.0;        ///< largest |a − b| / max(|a|, |b|, floor)
  double a = 0.0, b = 0.0;   ///< the values there
  std::string where;         ///< frame, time, particle, position; or line, step, time; or index
};

struct CompareResult {
  std::vector<FieldDifference> fields;
  std::vector<std::string> faults;      ///< what is missing, has another shape, or cannot be read
  std::vector<std::string> unreadable;  ///< those of the faults that are files that cannot be read
  std::vector<std::string> one_sided;   ///< what would be a fault, if it was not only what both sides hold that counts
  std::size_t compared() const;
  /// No field fails, nothing is missing, and something was compared.
  bool same() const;
  /// A line for each field, then what one side alone holds, then the faults, then the verdict.
  std::string text() const;
};

/// What is to be compared, and how closely.
struct CompareSettings {
  double tolerance = 1e-10, floor = 0.0;
  /// Fields with a tolerance and floor of their own; the first that matches counts.
  std::vector<FieldTolerance> own = {};
  /// Only what both sides hold, and of run files the particles that both hold, by their ids. What one side alone holds
  /// is told; other frames or rows, and no particle in common, still fail.
  bool common = false;
};

/// Compares two run folders, or two files of the same kind (.h5, .csv, .json), number by number. Two numbers agree when
/// |a − b| ≤ tolerance · max(|a|, |b|, floor). Fails on a side, a file or a field that is missing and on other shapes,
/// if not `common`, on a NaN on either side, on an own tolerance that matches no field, and when nothing was compared,
/// in all or in one of the files. In a run file, a frame that neither side has written is passed over. In JSON only
/// numbers count, without the keys `provenance`, `timing` and `speedup` and those that tell seconds of work or memory;
/// in a folder all files of the three kinds count, those of subfolders too. Not collective: one rank reads both. Throws
/// std::invalid_argument for a tolerance or floor that is negative or not finite.
CompareResult compare(const std::filesystem::path& a, const std::filesystem::path& b, const CompareSettings& settings);

}  // namespace kiln
