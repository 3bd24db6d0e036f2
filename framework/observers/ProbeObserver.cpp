#include "framework/observers/ProbeObserver.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/base/Error.hpp"
#include "framework/base/Loop.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/CsvTable.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {

Specification ProbeObserver::specification() {
  Specification point;
  point.text("name", "what the probe is called in probes.csv");
  point.reals("position", "where it lies").unit("m").length(3);
  Specification specification;
  specification.integer("every", "steps between two rows").at_least(1).defaults_to(1);
  specification.sections("points", "the probes", std::move(point));
  specification
      .real("tolerance",
            "farthest a probe may lie from a particle; without it, as far as that particle's nearest neighbour")
      .unit("m")
      .at_least(0)
      .optional();
  specification.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    std::vector<std::string> names;
    const Teuchos::ParameterList& points = list.sublist("points");
    for (int i = 0; points.isSublist(std::to_string(i)); ++i) {
      const auto name = points.sublist(std::to_string(i)).get<std::string>("name");
      if (std::find(names.begin(), names.end(), name) != names.end()) {
        problems.push_back({fmt::format("points.{}.name", i), fmt::format("'{}' is an earlier probe's name", name),
                            "a name of its own", ""});
      }
      names.push_back(name);
    }
  });
  return specification;
}

ProbeObserver::ProbeObserver(const Teuchos::ParameterList& list, const Context& context)
    : context_(context),
      method_(context.method),
      file_(context.folder / "probes.csv"),
      communicator_(context.communicator),
      every_(list.get<int>("every")),
      probes_(find_probes(list, context.method)),
      fields_(method_.fields()),
      part_(probes_.size() * fields_.size()) {
  std::vector<LocalIndex> places;
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    if (probes_[p].particle.rank != communicator_->getRank()) continue;
    mine_.push_back(p);
    places.push_back(probes_[p].particle.local);
  }
  reader_ = method_.reader(places);
  read_ = VectorView("kiln::observers::probes", places.size() * fields_.size());
  read_host_ = Kokkos::create_mirror_view(read_);
}

void ProbeObserver::begin() {
  // Each number is on one rank and 0 on the others.
  const auto join = [](const std::vector<const double*>& parts, std::vector<double>& numbers) {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      numbers[k] = 0.0;
      for (const double* part : parts) numbers[k] += part[k];
    }
  };
  log_ = std::make_unique<CsvLog>(file_, columns(), context_.first_step, part_.size(), join, communicator_);
  write_places();
}

std::vector<std::string> ProbeObserver::columns() const {
  std::vector<std::string> columns{"step", "time [s]"};
  for (const Probe& probe : probes_) {
    for (const Field& field : fields_) columns.push_back(fmt::format("{} {} [{}]", probe.name, field.name, field.unit));
  }
  return columns;
}

void ProbeObserver::write_places() const {
  nlohmann::ordered_json places = nlohmann::ordered_json::array();
  for (const Probe& probe : probes_) {
    nlohmann::ordered_json place;
    place["name"] = probe.name;
    place["point_m"] = probe.point;
    place["particle"] = probe.particle.id;
    place["position_m"] = probe.particle.position;
    place["distance_m"] = probe.particle.distance;
    places.push_back(std::move(place));
  }
  write_atomically(context_.folder / "probes.json", json_text(places, 2) + "\n", communicator_);
}

void ProbeObserver::observe(const Moment& moment) {
  if (moment.step % every_ == 0 || moment.step == moment.last_step) add_row(moment);
  if (moment.checkpoint) log_->flush();
}

void ProbeObserver::add_row(const Moment& moment) {
  reader_(moment.x, read_);
  copy_to_host(read_, read_host_);
  const std::size_t components = fields_.size();
  for (std::size_t i = 0; i < mine_.size(); ++i) {
    for (std::size_t c = 0; c < components; ++c) part_[mine_[i] * components + c] = read_host_(i * components + c);
  }
  log_->add(moment.step, moment.time, part_);
}

/// From the file, so that a restarted run's summary covers its earlier part too.
nlohmann::json ProbeObserver::summary() const {
  const CsvTable table = read_csv(file_);
  const std::size_t components = fields_.size();
  nlohmann::json section = nlohmann::json::array();
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    nlohmann::json probe = {
        {"name", probes_[p].name}, {"particle", probes_[p].particle.id}, {"position_m", probes_[p].particle.position}};
    for (std::size_t c = 0; c < components && !table.rows.empty(); ++c) {
      const std::size_t column = 2 + p * components + c;
      const auto lower = [column](const std::vector<double>& a, const std::vector<double>& b) {
        return a[column] < b[column];
      };
      const std::vector<double>& highest = *std::max_element(table.rows.begin(), table.rows.end(), lower);
      probe[fields_[c].name] = {{"unit", fields_[c].unit},
                                {"highest", highest[column]},
                                {"highest_at_s", highest[1]},
                                {"last", table.rows.back()[column]}};
    }
    section.push_back(std::move(probe));
  }
  return section;
}

void ProbeObserver::finish(RunReport& report) {
  log_->flush();
  std::string text;
  on_root(*communicator_, file_.string(), [&]() -> std::optional<Fault> {
    text = json_text(summary());
    return std::nullopt;
  });
  report.section("probes") = nlohmann::json::parse(broadcast(*communicator_, text));
}

KILN_REGISTER(Observer, ProbeObserver, "probes", "histories of the state at given points: probes.csv");

}  // namespace kiln
