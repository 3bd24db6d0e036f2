#pragma once

#include <functional>
#include <string>

#include "framework/files/Compare.hpp"

namespace kiln {

/// Compares the numbers of one field after the other and keeps the worst.
class NumberComparison {
 public:
  NumberComparison(double tolerance, double floor, CompareResult& result)
      : tolerance_(tolerance), floor_(floor), result_(result) {}

  /// The numbers that follow belong to this field.
  void begin(const std::string& field) { result_.fields.push_back({field, 0, 0, 0.0, 0.0, 0.0, {}}); }
  /// `where` is asked only when this is the worst so far.
  void add(double a, double b, const std::function<std::string()>& where);
  void fault(const std::string& text) { result_.faults.push_back(text); }

 private:
  double tolerance_;
  double floor_;
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
