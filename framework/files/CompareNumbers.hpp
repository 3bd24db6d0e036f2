#pragma once

#include <functional>
#include <string>

#include "framework/files/Compare.hpp"

namespace kiln {

/// Compares the numbers of one field after the other and keeps the worst.
class NumberComparison {
 public:
  NumberComparison(const CompareSettings& settings, CompareResult& result)
      : settings_(settings), used_(settings.own.size(), false), result_(result) {}

  /// Whether only what both sides hold is compared.
  bool common() const { return settings_.common; }
  /// The numbers that follow belong to this field.
  void begin(const std::string& field);
  /// `where` is asked only when this is the worst so far.
  void add(double a, double b, const std::function<std::string()>& where);
  void fault(const std::string& text) { result_.faults.push_back(text); }
  /// Of what one side alone holds: a fault unless only what is common counts.
  void one_sided(const std::string& text) { (common() ? result_.one_sided : result_.faults).push_back(text); }
  void unreadable(const std::string& text) {
    fault(text);
    result_.unreadable.push_back(text);
  }
  std::size_t compared() const { return result_.compared(); }
  /// Faults, and what one side alone holds.
  std::size_t told() const { return result_.faults.size() + result_.one_sided.size(); }
  /// Faults the tolerances that named no field: they may be misspelt, and then the field they meant had another one.
  void fault_unused_tolerances();

 private:
  const CompareSettings& settings_;
  std::vector<bool> used_;  ///< of the fields' own tolerances
  CompareResult& result_;
};

/// Each compares two files of its kind; `label` stands in front of the fields' names.
void compare_hdf5(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                  NumberComparison& comparison);
void compare_csv(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                 NumberComparison& comparison);
void compare_json(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                  NumberComparison& comparison);

}  // namespace kiln
