#pragma once

#include <Teuchos_ParameterList.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kiln {

/// Documentation string of those entries of a checked input that name data files.
constexpr const char* names_data_file = "names a data file";

/// An entry that names a data file.
struct DataFile {
  std::string path;  ///< of the entry, dotted, from the top of the input
  std::string file;
};

/// All data files that a block of a checked input names.
std::vector<DataFile> data_files(const Teuchos::ParameterList& block);

/// The hash of a data file: {"xxh3": …} (128 bits) or, of a sealed HDF5 file, {"seal": …}, its fingerprint (Seal.hpp),
/// for which only its end is read. {"xxh3": "unreadable"} where it is gone since it was checked. Not collective.
nlohmann::json hash_of_data(const std::string& file);

}  // namespace kiln
