#include "framework/report/RunReport.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"

namespace kiln {

nlohmann::json read_report(const std::filesystem::path& folder, const Communicator& communicator) {
  const std::string path = (folder / "report.json").string();
  std::ostringstream text;
  on_root(communicator, path, [&]() -> std::optional<Fault> {
    std::ifstream file(path);
    if (!file) return system_fault("read", errno);
    if (std::filesystem::is_directory(path)) return Fault{"", "is a folder", "a report"};
    text << file.rdbuf();
    return std::nullopt;
  });
  nlohmann::json facts = parse_json(broadcast(communicator, text.str()));
  if (!facts.is_object())
    throw FileError(path, "", "is no JSON object", "a report that `kiln run` or `kiln train` wrote");
  return facts;
}

}  // namespace kiln
