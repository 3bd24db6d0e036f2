#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/files/CsvLog.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/observers/Probes.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Writes the state at given points into probes.csv, one row every so many steps. A probe reads the particle nearest to
/// its point; probes.json says which one that is, and where. A point too far from any particle is a mistake of the
/// input: too far means farther than `tolerance`, and without that key farther than that particle's own nearest
/// neighbour.
class ProbeObserver : public Observer {
 public:
  static Specification specification();
  /// Throws InputError that lists all probes outside the particles, FileError when its files cannot be written.
  ProbeObserver(const Teuchos::ParameterList& list, const Context& context);

  void begin() override;
  void observe(const Moment& moment) override;
  void finish(RunReport& report) override;

 private:
  void write_places() const;
  std::vector<std::string> columns() const;
  void add_row(const Moment& moment);
  nlohmann::json summary() const;

  Context context_;
  Method& method_;
  std::filesystem::path file_;
  Teuchos::RCP<const Communicator> communicator_;
  int every_;
  std::vector<Probe> probes_;
  std::vector<Field> fields_;
  std::vector<std::size_t> mine_;  ///< probes whose particle is on this rank
  Method::Reader reader_;          ///< of these
  VectorView read_;
  VectorView::HostMirror read_host_;
  std::vector<double> part_;     ///< probe by probe, component by component; 0 where another rank has the particle
  std::unique_ptr<CsvLog> log_;  ///< null before begin()
};

}  // namespace kiln
