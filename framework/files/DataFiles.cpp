#include "framework/files/DataFiles.hpp"

#include "framework/base/Error.hpp"
#include "framework/base/Hash.hpp"
#include "framework/files/Seal.hpp"

namespace kiln {

std::vector<DataFile> data_files(const Teuchos::ParameterList& block) {
  std::vector<DataFile> result;
  for (auto item = block.begin(); item != block.end(); ++item) {
    const std::string& key = block.name(item);
    const Teuchos::ParameterEntry& entry = block.entry(item);
    if (entry.isList()) {
      for (DataFile& file : data_files(block.sublist(key))) result.push_back(std::move(file));
    } else if (entry.docString() == names_data_file) {
      result.push_back({block.name() + "." + key, Teuchos::getValue<std::string>(entry)});
    }
  }
  return result;
}

nlohmann::json hash_of_data(const std::string& file) {
  try {
    const std::vector<hdf5::Segment> seal = hdf5::read_seal(file, false);
    if (!seal.empty()) return {{"seal", hdf5::fingerprint(seal)}};
    return {{"xxh3", hash_of_file(file)}};
  } catch (const FileError&) {
    return {{"xxh3", "unreadable"}};
  }
}

}  // namespace kiln
