#include "physics/sph/Material.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>

#include "framework/files/CsvColumns.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

/// 316L stainless steel, Eqs. 15–17.
class Steel316L final : public Material {
 public:
  static Specification specification() { return {}; }
  Steel316L(const Teuchos::ParameterList&, const Context&) {}

  MaterialPoint<double> at(double u) const override {
    constexpr double melting = 1660.5;
    constexpr double boiling = 3090.0;
    if (u < melting) {
      return {9.248 + 1.571e-2 * u, 458.984 + 0.1328 * u, 8084.2 - 0.4209 * u - 3.8942e-5 * u * u};
    }
    if (u <= boiling) {
      return {12.41 + 3.279e-3 * u, 769.855, 7432.7 + 3.9338e-2 * u - 1.8007e-4 * u * u};
    }
    return {21.6465, 769.855, 6124.72};
  }
};

class ConstantMaterial final : public Material {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("conductivity", "heat conductivity k").unit("W/(m K)").above(0);
    specification.real("specific_heat", "specific heat c").unit("J/(kg K)").above(0);
    specification.real("density", "density").unit("kg/m^3").above(0);
    return specification;
  }
  ConstantMaterial(const Teuchos::ParameterList& list, const Context&)
      : point_{list.get<double>("conductivity"), list.get<double>("specific_heat"), list.get<double>("density")} {}

  MaterialPoint<double> at(double) const override { return point_; }

 private:
  MaterialPoint<double> point_;
};

/// Measured values, linear between the lines of the file and the end values outside.
class TableMaterial final : public Material {
 public:
  static Specification specification() {
    Specification specification;
    specification.file(
        "path",
        "CSV file with columns temperature (K, rising), conductivity (W/(m K)), specific heat (J/(kg K)), "
        "density (kg/m^3)");
    return specification;
  }
  TableMaterial(const Teuchos::ParameterList& list, const Context& context) {
    const auto file = list.get<std::string>("path");
    const std::vector<std::string> columns = {"temperature", "conductivity", "specific heat", "density"};
    const CsvColumns csv = read_csv_columns(file, columns, {}, *context.communicator);
    temperatures_ = csv.values[csv.find(columns[0])];
    for (std::size_t i = 0; i < temperatures_.size(); ++i) {
      if (i > 0 && !(temperatures_[i] > temperatures_[i - 1])) {
        throw FileError(file, fmt::format("line {}", csv.lines[i]),
                        fmt::format("temperature {} follows {}", temperatures_[i], temperatures_[i - 1]),
                        "rising temperatures");
      }
      points_.push_back({csv.values[csv.find(columns[1])][i], csv.values[csv.find(columns[2])][i],
                         csv.values[csv.find(columns[3])][i]});
    }
  }

  MaterialPoint<double> at(double u) const override {
    const auto above = std::upper_bound(temperatures_.begin(), temperatures_.end(), u);
    if (above == temperatures_.begin()) return points_.front();
    if (above == temperatures_.end()) return points_.back();
    const std::size_t i = static_cast<std::size_t>(above - temperatures_.begin()) - 1;
    const double fraction = (u - temperatures_[i]) / (temperatures_[i + 1] - temperatures_[i]);
    const MaterialPoint<double>& a = points_[i];
    const MaterialPoint<double>& b = points_[i + 1];
    return {a.conductivity + fraction * (b.conductivity - a.conductivity),
            a.specific_heat + fraction * (b.specific_heat - a.specific_heat),
            a.density + fraction * (b.density - a.density)};
  }

 private:
  std::vector<double> temperatures_;
  std::vector<MaterialPoint<double>> points_;
};

/// One property as a formula in u, by muParser.
class Formula {
 public:
  Formula(const Teuchos::ParameterList& list, const std::string& key)
      : path_(list.name() + "." + key), text_(list.get<std::string>(key)) {
    try {
      parser_.DefineVar("u", &u_);
      parser_.SetExpr(text_);
      parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      fail(error);
    }
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  double operator()(double u) {
    u_ = u;
    try {
      return parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      fail(error);
    }
  }

 private:
  [[noreturn]] void fail(const mu::Parser::exception_type& error) const {
    throw InputError(path_, fmt::format("'{}': {}", text_, error.GetMsg()),
                     "a formula in the temperature u in K, e.g. u < 1660.5 ? 9.248 + 1.571e-2*u : 17.9");
  }

  std::string path_;
  std::string text_;
  double u_ = 300.0;
  mu::Parser parser_;
};

class FormulaMaterial final : public Material {
 public:
  static Specification specification() {
    Specification specification;
    specification.text("conductivity", "k in W/(m K) as a formula in the temperature u in K");
    specification.text("specific_heat", "c in J/(kg K) as a formula in u");
    specification.text("density", "density in kg/m^3 as a formula in u");
    return specification;
  }
  FormulaMaterial(const Teuchos::ParameterList& list, const Context&)
      : conductivity_(std::make_unique<Formula>(list, "conductivity")),
        specific_heat_(std::make_unique<Formula>(list, "specific_heat")),
        density_(std::make_unique<Formula>(list, "density")) {}

  MaterialPoint<double> at(double u) const override {
    return {(*conductivity_)(u), (*specific_heat_)(u), (*density_)(u)};
  }

 private:
  // A parser writes to itself while it evaluates.
  std::unique_ptr<Formula> conductivity_;
  std::unique_ptr<Formula> specific_heat_;
  std::unique_ptr<Formula> density_;
};

KILN_REGISTER(Material, Steel316L, "316L", "316L stainless steel (Eqs. 15-17)");
KILN_REGISTER(Material, ConstantMaterial, "constant", "properties that do not change with temperature");
KILN_REGISTER(Material, TableMaterial, "table", "properties from a CSV file, linear between its lines");
KILN_REGISTER(Material, FormulaMaterial, "formula", "properties as formulas in the temperature u");

}  // namespace
}  // namespace kiln
