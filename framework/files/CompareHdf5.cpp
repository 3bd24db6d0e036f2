#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "framework/files/CompareNumbers.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {
namespace {

constexpr int deepest = 32;

std::string index_text(std::size_t flat, const std::vector<std::size_t>& shape) {
  std::vector<std::size_t> index(shape.size());
  for (std::size_t d = shape.size(); d-- > 0;) {
    index[d] = flat % shape[d];
    flat /= shape[d];
  }
  return fmt::format("[{}]", fmt::join(index, ", "));
}

/// Copies of what stands elsewhere in a run file.
bool is_view(const std::string& path) { return path == "/frame" || path == "/VTKHDF"; }

/// What a run file says of its rows and columns.
class RunFacts {
 public:
  explicit RunFacts(const hdf5::Group& root) {
    if (!root.holds_reals("time") || !root.holds_integers("particle") || !root.holds_reals("position")) return;
    time_ = root.reals("time").values;
    particle_ = root.integers("particle").values;
    position_ = root.reals("position").values;
    is_run_ = position_.size() == 3 * particle_.size();
  }
  bool is_run() const { return is_run_; }
  bool is_frames(const std::vector<std::size_t>& shape) const {
    return is_run_ && shape.size() == 2 && shape[0] == time_.size() && shape[1] == particle_.size();
  }
  std::size_t frames() const { return time_.size(); }
  const std::vector<long long>& particles() const { return particle_; }
  double position(std::size_t i, std::size_t axis) const { return position_[3 * i + axis]; }
  bool written(std::size_t frame) const { return !std::isnan(time_[frame]); }
  std::string where(std::size_t frame, std::size_t i) const {
    return fmt::format("frame {}, t = {:.6g} s, particle {} at ({:.6g}, {:.6g}, {:.6g}) m", frame, time_[frame],
                       particle_[i], position_[3 * i], position_[3 * i + 1], position_[3 * i + 2]);
  }

 private:
  bool is_run_ = false;
  std::vector<double> time_, position_;
  std::vector<long long> particle_;
};

class Hdf5Comparison {
 public:
  Hdf5Comparison(const hdf5::Group& a, const hdf5::Group& b, std::string label, NumberComparison& comparison)
      : facts_a_(a), facts_b_(b), label_(std::move(label)), comparison_(comparison) {
    if (!is_run()) return;
    if (comparison.common()) {
      pair_particles();
    } else {
      pair_rows();
    }
  }

  void compare(const hdf5::Group& a, const hdf5::Group& b) {
    compare_groups(a, b, 0);
    // Times and positions alone say nothing of two runs.
    if (is_run() && comparison_.common() && !found_field_) {
      comparison_.fault(label_ + "there is no field that both hold");
    }
  }

 private:
  bool is_run() const { return facts_a_.is_run() && facts_b_.is_run(); }

  void compare_groups(const hdf5::Group& a, const hdf5::Group& b, int depth) {
    // Hard links may lead round in a circle.
    if (depth > deepest) return comparison_.fault(fmt::format("{}{} is nested too deeply", label_, a.path()));
    std::set<std::string> names;
    for (const hdf5::Group* group : {&a, &b}) {
      for (const std::string& name : group->names()) names.insert(name);
    }
    for (const std::string& name : names) {
      const std::string path = a.path() == "/" ? "/" + name : a.path() + "/" + name;
      if (is_run() && is_view(path)) continue;
      if (!a.has(name) || !b.has(name)) {
        comparison_.one_sided(fmt::format("{}{} is missing in {}", label_, path, (a.has(name) ? b : a).file()));
      } else {
        compare_objects(a, b, name, path, depth);
      }
    }
  }

  void pair_rows() {
    const std::size_t rows = std::min(facts_a_.particles().size(), facts_b_.particles().size());
    for (std::size_t i = 0; i < rows; ++i) pairs_.emplace_back(i, i);
  }

  void pair_particles() {
    const std::vector<long long>&a = facts_a_.particles(), &b = facts_b_.particles();
    std::map<long long, std::size_t> row_of;
    for (std::size_t j = 0; j < b.size(); ++j) row_of.emplace(b[j], j);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto other = row_of.find(a[i]);
      if (other != row_of.end()) pairs_.emplace_back(i, other->second);
    }
    if (pairs_.empty()) return comparison_.fault(label_ + "there is no particle that both hold");
    if (pairs_.size() == a.size() && pairs_.size() == b.size()) return;
    comparison_.one_sided(
        fmt::format("{}{} and {} particles, {} of them common", label_, a.size(), b.size(), pairs_.size()));
  }

  void compare_objects(const hdf5::Group& a, const hdf5::Group& b, const std::string& name, const std::string& path,
                       int depth) {
    const bool reals = a.holds_reals(name), integers = a.holds_integers(name);
    if (reals != b.holds_reals(name) || integers != b.holds_integers(name)) {
      return comparison_.fault(label_ + path + " is of different kinds");
    }
    if (!reals && !integers) return compare_groups(a.group(name), b.group(name), depth + 1);
    const std::vector<std::size_t> shape = a.shape(name), other_shape = b.shape(name);
    const bool common_rows = is_run() && comparison_.common();
    if (common_rows && path == "/particle") return;
    if (common_rows && path == "/position") return compare_positions(path);
    const bool is_field = reals && is_run() && facts_a_.is_frames(shape) && facts_b_.is_frames(other_shape);
    found_field_ = found_field_ || is_field;
    if (is_field && (shape == other_shape || (common_rows && facts_a_.frames() == facts_b_.frames()))) {
      return compare_frames(a, b, name, path);
    }
    if (shape != other_shape) {
      // Nothing would be left to compare.
      if (common_rows && (is_field || path == "/time" || path == "/step")) {
        return comparison_.fault(fmt::format("{}{} has {} and {} frames", label_, path, shape[0], other_shape[0]));
      }
      return comparison_.one_sided(fmt::format("{}{} has shape {} and {}", label_, path, fmt::join(shape, " × "),
                                               fmt::join(other_shape, " × ")));
    }
    comparison_.begin(label_ + path);
    if (integers) {
      const auto left = a.integers(name).values, right = b.integers(name).values;
      for (std::size_t i = 0; i < left.size(); ++i) {
        comparison_.add(static_cast<double>(left[i]), static_cast<double>(right[i]),
                        [&] { return index_text(i, shape); });
      }
      return;
    }
    const bool times = is_run() && path == "/time";
    const auto left = a.reals(name).values, right = b.reals(name).values;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (times && std::isnan(left[i]) && std::isnan(right[i])) continue;
      comparison_.add(left[i], right[i], [&] { return index_text(i, shape); });
    }
  }

  void compare_frames(const hdf5::Group& a, const hdf5::Group& b, const std::string& name, const std::string& path) {
    comparison_.begin(label_ + path);
    for (std::size_t frame = 0; frame < facts_a_.frames(); ++frame) {
      if (!facts_a_.written(frame) && !facts_b_.written(frame)) continue;
      const auto left = a.read_block(name, {frame, 0}, {1, facts_a_.particles().size()});
      const auto right = b.read_block(name, {frame, 0}, {1, facts_b_.particles().size()});
      const RunFacts& facts = facts_a_.written(frame) ? facts_a_ : facts_b_;
      for (const auto& [i, j] : pairs_) {
        comparison_.add(left[i], right[j], [&, row = &facts == &facts_a_ ? i : j] { return facts.where(frame, row); });
      }
    }
  }

  void compare_positions(const std::string& path) {
    comparison_.begin(label_ + path);
    for (const auto& [i, j] : pairs_) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        comparison_.add(facts_a_.position(i, axis), facts_b_.position(j, axis),
                        [&, i = i] { return fmt::format("particle {}", facts_a_.particles()[i]); });
      }
    }
  }

  RunFacts facts_a_, facts_b_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  ///< rows of the same particle
  bool found_field_ = false;                                ///< that both hold
  std::string label_;
  NumberComparison& comparison_;
};

}  // namespace

void compare_hdf5(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                  NumberComparison& comparison) {
  const Teuchos::RCP<const Communicator> alone = Teuchos::rcp(new Teuchos::SerialComm<int>());
  const auto left = hdf5::File::read(a.string(), alone), right = hdf5::File::read(b.string(), alone);
  Hdf5Comparison(left, right, label, comparison).compare(left, right);
}

}  // namespace kiln
