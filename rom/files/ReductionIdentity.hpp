#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <string>

#include "framework/files/Hdf5.hpp"
#include "framework/model/Parameters.hpp"

namespace kiln {

/// What ties a reduction file to the model and the time stepping it was learnt from.
namespace reduction_identity {

constexpr const char* format = "kiln reduction";
constexpr long long version = 4;

/// Hashes of the data files that the block `model` names, as they are now, by the paths of their entries. Collective.
std::map<std::string, std::string> data_hashes(const Teuchos::ParameterList& model, const Communicator& communicator);

/// Writes format, version, the model's checked block with its hash, the hashes of its data files, its live parameters,
/// time step and scheme.
void write(hdf5::Group& root, const Teuchos::ParameterList& input, const Parameters& parameters,
           const std::map<std::string, std::string>& data_hashes);

/// Throws FileError for a file that is no reduction, or one of another format version.
void require_format(const hdf5::Group& root);
/// Throws FileError that names the first entries that differ from the block `model` of the input, the live parameters
/// apart: these may be set anew for each run. Of entries that name data files it is the content that counts, not where
/// the file lies. Collective.
void require_model(const hdf5::Group& root, const Teuchos::ParameterList& model);
/// Throws FileError for a time step or scheme that differs from the block `time` of the input.
void require_time(const hdf5::Group& root, const Teuchos::ParameterList& time);

}  // namespace reduction_identity

}  // namespace kiln
