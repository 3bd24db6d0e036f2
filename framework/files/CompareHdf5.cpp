#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <cmath>
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
      : facts_a_(a), facts_b_(b), label_(std::move(label)), comparison_(comparison) {}

  void compare_groups(const hdf5::Group& a, const hdf5::Group& b, int depth = 0) {
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
        comparison_.fault(fmt::format("{}{} is missing in {}", label_, path, (a.has(name) ? b : a).file()));
      } else {
        compare_objects(a, b, name, path, depth);
      }
    }
  }

 private:
  bool is_run() const { return facts_a_.is_run() && facts_b_.is_run(); }

  void compare_objects(const hdf5::Group& a, const hdf5::Group& b, const std::string& name, const std::string& path,
                       int depth) {
    const bool reals = a.holds_reals(name), integers = a.holds_integers(name);
    if (reals != b.holds_reals(name) || integers != b.holds_integers(name)) {
      return comparison_.fault(label_ + path + " is of different kinds");
    }
    if (!reals && !integers) return compare_groups(a.group(name), b.group(name), depth + 1);
    const std::vector<std::size_t> shape = a.shape(name);
    if (shape != b.shape(name)) {
      return comparison_.fault(fmt::format("{}{} has shape {} and {}", label_, path, fmt::join(shape, " × "),
                                           fmt::join(b.shape(name), " × ")));
    }
    if (reals && is_run() && facts_a_.is_frames(shape) && facts_b_.is_frames(shape)) {
      return compare_frames(a, b, name, path, shape[1]);
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

  void compare_frames(const hdf5::Group& a, const hdf5::Group& b, const std::string& name, const std::string& path,
                      std::size_t particles) {
    comparison_.begin(label_ + path);
    for (std::size_t frame = 0; frame < facts_a_.frames(); ++frame) {
      if (!facts_a_.written(frame) && !facts_b_.written(frame)) continue;
      const auto left = a.read_block(name, {frame, 0}, {1, particles});
      const auto right = b.read_block(name, {frame, 0}, {1, particles});
      const RunFacts& facts = facts_a_.written(frame) ? facts_a_ : facts_b_;
      for (std::size_t i = 0; i < particles; ++i) {
        comparison_.add(left[i], right[i], [&] { return facts.where(frame, i); });
      }
    }
  }

  RunFacts facts_a_, facts_b_;
  std::string label_;
  NumberComparison& comparison_;
};

}  // namespace

void compare_hdf5(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                  NumberComparison& comparison) {
  const Teuchos::RCP<const Communicator> alone = Teuchos::rcp(new Teuchos::SerialComm<int>());
  const auto left = hdf5::File::read(a.string(), alone), right = hdf5::File::read(b.string(), alone);
  Hdf5Comparison(left, right, label, comparison).compare_groups(left, right);
}

}  // namespace kiln
