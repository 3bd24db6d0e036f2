#include <fmt/format.h>

#include <cmath>

#include "framework/base/Pi.hpp"
#include "framework/files/CsvColumns.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/vortex/Vortices.hpp"

namespace kiln {
namespace {

/// Two vortices on the x-axis, the origin half way between them.
class VortexPair final : public Vortices {
 public:
  static Specification specification() {
    Specification specification;
    specification.reals("circulations", "of the left and the right vortex").unit("m^2/s").length(2);
    specification.real("separation", "their distance").unit("m").above(0);
    return specification;
  }

  VortexPair(const Teuchos::ParameterList& list, const Context&) : separation_(list.get<double>("separation")) {
    const auto circulations = list.get<Teuchos::Array<double>>("circulations");
    left_ = circulations[0];
    right_ = circulations[1];
  }

  VortexCloud cloud() const override {
    VortexCloud cloud;
    cloud.add(-0.5 * separation_, 0.0, left_);
    cloud.add(0.5 * separation_, 0.0, right_);
    return cloud;
  }

 private:
  double separation_, left_, right_;
};

/// A shear layer of finite length along x, centred at the origin: equal vortices in rows, displaced along y by a sine.
/// Above it the fluid moves faster by the velocity jump than below. Ids run along x, then y.
class ShearLayer final : public Vortices {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("length", "of the layer").unit("m").above(0);
    specification.integer("count", "vortices along the layer").at_least(1);
    specification.integer("rows", "rows of vortices across the layer").at_least(1).defaults_to(1);
    specification.real("thickness", "of the layer; rows share it equally").unit("m").at_least(0).defaults_to(0.0);
    specification.real("velocity_jump", "velocity above the layer less that below").unit("m/s");
    specification.real("amplitude", "of the sine that displaces it").unit("m").at_least(0).defaults_to(0.0);
    specification.real("waves", "wavelengths of the sine along the layer").at_least(0).defaults_to(1.0);
    specification.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
      if (list.get<int>("rows") > 1 && !(list.get<double>("thickness") > 0.0)) {
        problems.push_back({"thickness", fmt::format("is 0, and there are {} rows", list.get<int>("rows")),
                            "a thickness in m above 0, or rows: 1", ""});
      }
    });
    return specification;
  }

  ShearLayer(const Teuchos::ParameterList& list, const Context&)
      : length_(list.get<double>("length")),
        count_(list.get<int>("count")),
        rows_(list.get<int>("rows")),
        thickness_(list.get<double>("thickness")),
        velocity_jump_(list.get<double>("velocity_jump")),
        amplitude_(list.get<double>("amplitude")),
        waves_(list.get<double>("waves")) {}

  VortexCloud cloud() const override {
    VortexCloud cloud;
    const double circulation = -velocity_jump_ * length_ / (static_cast<double>(count_) * rows_);
    for (int row = 0; row < rows_; ++row) {
      const double across = ((row + 0.5) / rows_ - 0.5) * thickness_;
      for (int i = 0; i < count_; ++i) {
        const double along = (i + 0.5) / count_;
        cloud.add((along - 0.5) * length_, across + amplitude_ * std::sin(2.0 * pi * waves_ * along), circulation);
      }
    }
    return cloud;
  }

 private:
  double length_;
  int count_, rows_;
  double thickness_, velocity_jump_, amplitude_, waves_;
};

/// Any vortices, from columns x, y and circulation of a CSV file with a header line. A particle's id is its row.
class VortexFile final : public Vortices {
 public:
  static Specification specification() {
    Specification specification;
    specification.file("path", "CSV file with columns x (m), y (m) and circulation (m^2/s)");
    return specification;
  }

  VortexFile(const Teuchos::ParameterList& list, const Context& context)
      : path_(list.get<std::string>("path")), communicator_(context.communicator) {}

  VortexCloud cloud() const override {
    const CsvColumns csv = read_csv_columns(path_, {"x", "y", "circulation"}, {}, *communicator_);
    return {csv.values[csv.find("x")], csv.values[csv.find("y")], csv.values[csv.find("circulation")]};
  }

 private:
  std::string path_;
  Teuchos::RCP<const Communicator> communicator_;
};

KILN_REGISTER(Vortices, VortexPair, "pair", "two vortices");
KILN_REGISTER(Vortices, ShearLayer, "shear layer", "rows of equal vortices, displaced by a sine");
KILN_REGISTER(Vortices, VortexFile, "file", "vortices from a CSV file");

}  // namespace
}  // namespace kiln
