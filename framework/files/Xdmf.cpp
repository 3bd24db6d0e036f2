#include "framework/files/Xdmf.hpp"

#include <fmt/format.h>

#include <iterator>

namespace kiln {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string data_item(const std::string& dimensions, const char* type, const std::string& place) {
  return fmt::format(R"(<DataItem Dimensions="{}" NumberType="{}" Precision="8" Format="HDF">{}</DataItem>)",
                     dimensions, type, escaped(place));
}

}  // namespace

std::string xdmf(const std::string& file, std::size_t particles, const std::vector<Field>& fields,
                 const std::vector<XdmfFrame>& frames) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  const auto add = std::back_inserter(text);
  const std::string count = std::to_string(particles);
  for (const XdmfFrame& frame : frames) {
    fmt::format_to(add, "      <Grid Name=\"particles\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n",
                   frame.time);
    fmt::format_to(add,
                   "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}"
                   "</Topology>\n        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                   count, data_item(count, "Int", file + ":/VTKHDF/Connectivity"),
                   data_item(count + " 3", "Float", file + ":/position"));
    for (const Field& field : fields) {
      fmt::format_to(add,
                     "        <Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Node\">\n"
                     "          <Information Name=\"unit\" Value=\"{}\"/>\n          {}\n        </Attribute>\n",
                     escaped(field.name), escaped(field.unit),
                     data_item(count, "Float", fmt::format("{}:/frame/{}/{}", file, field.name, frame.frame)));
    }
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace kiln
