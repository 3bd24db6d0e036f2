#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/ExchangeInterval.hpp"
#include "framework/base/Field.hpp"
#include "framework/base/LinearAlgebra.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/RowOrder.hpp"
#include "framework/files/Xdmf.hpp"

namespace kiln {

/// A run's fields over time: `run.h5`, and `run.xdmf` beside it for ParaView.
///
/// | dataset | shape | holds |
/// | --- | --- | --- |
/// | `/particle` | n | global ids, ascending |
/// | `/position` | n × 3 | m |
/// | `/time`, `/step` | frames | s; NaN and −1 for a frame that is not written yet |
/// | `/FIELD` | frames × n | one for each component of the state, with its unit |
/// | `/coordinates` | frames × M | reduced coordinates û, of reduced methods |
/// | `/frame/FIELD/K` | n | row K of `/FIELD`; a view, for readers of XDMF |
/// | `/VTKHDF` | | particles and the newest frame, for VTK ≥ 9.1 |
///
/// Each dataset has an attribute `unit`; the root's attributes are the run's provenance. The file gets its name when
/// all space is taken and all metadata written, none of which changes later: a run that is killed leaves a file that
/// can be read.
class RunFile {
 public:
  struct Contents {
    std::vector<Field> fields;
    std::vector<int> steps;                         ///< the step of each frame, ascending
    std::map<std::string, std::string> provenance;  ///< attributes of the root
    std::size_t coordinates = 0;                    ///< length of û; 0: the unknown is the state
  };

  /// Makes `folder`/run.h5, or opens it to write the frames after `first_step` when that is above 0. positions:
  /// particles × 3 in m. Throws FileError; among others when an existing file holds other particles, fields or frames.
  /// Collective.
  RunFile(std::filesystem::path folder, const Map& particles, ConstPositionView positions, Contents contents,
          int first_step, Teuchos::RCP<const Communicator> communicator);

  /// Writes the frame of `step`, one of Contents::steps. u: particles × components; x: the method's unknown, looked at
  /// where Contents::coordinates is not 0. Collective.
  void write(int step, double time, ConstVectorView u, ConstVectorView x = {});
  /// Makes run.xdmf list all frames so far. write() does so only about four times a second, and the less often the more
  /// frames there are. Collective.
  void write_xdmf();

  std::size_t frames_written() const { return written_.size(); }
  std::string path() const { return (folder_ / "run.h5").string(); }

 private:
  static constexpr std::size_t none_listed = static_cast<std::size_t>(-1);

  /// A whole file without frames.
  hdf5::File created(ConstPositionView positions) const;
  void fill(hdf5::File& file, ConstPositionView positions) const;
  void fill_vtkhdf(hdf5::File& file) const;
  /// The file of an interrupted run, without the frames after `first_step`; written_ lists the others.
  hdf5::File reopened(int first_step);
  bool xdmf_is_due();
  std::size_t root_count() const { return communicator_->getRank() == 0 ? 1 : 0; }

  std::filesystem::path folder_;
  Teuchos::RCP<const Communicator> communicator_;
  Contents contents_;
  RowOrder order_;
  std::vector<XdmfFrame> written_;
  std::size_t listed_ = none_listed;  ///< frames in run.xdmf
  ExchangeInterval xdmf_interval_;    ///< of frames, between two versions of run.xdmf
  hdf5::File file_;
  hdf5::OpenedDataset times_, steps_;
  std::vector<hdf5::OpenedDataset> fields_;
  std::vector<hdf5::OpenedDataset> newest_;         ///< VTKHDF/PointData
  std::optional<hdf5::OpenedDataset> coordinates_;  ///< of reduced methods
};

}  // namespace kiln
