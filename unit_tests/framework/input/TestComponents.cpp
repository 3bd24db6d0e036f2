#include "unit_tests/framework/input/TestComponents.hpp"

namespace kiln::test {
namespace {

class CubicSpline : public Kernel {
 public:
  static Specification specification() { return {}; }
  CubicSpline(const Teuchos::ParameterList&, const NoContext&) {}
  double radius() const override { return 2; }
};
KILN_REGISTER(Kernel, CubicSpline, "conic spline", "Piecewise conic");

class Wendland : public Kernel {
 public:
  static Specification specification() {
    Specification s;
    s.real("radius", "support in multiples of h").above(0).at_most(3).defaults_to(2.0);
    return s;
  }
  Wendland(const Teuchos::ParameterList& list, const NoContext&) : radius_(list.get<double>("radius")) {}
  double radius() const override { return radius_; }

 private:
  double radius_;
};
KILN_REGISTER(Kernel, Wendland, "wendland c9", "Compactly supported polynomial");

class GaussianBeam : public Source {
 public:
  static Specification specification() {
    Specification s;
    s.real("power", "absorbed power").unit("W").above(0);
    s.real("width", "standard deviation").unit("m").above(0).defaults_to(5e-5);
    s.reals("velocity", "of the lamp").unit("m/s").length(2).optional();
    s.component<Kernel>("shape", "how it is smoothed").defaults_to("wendland c9");
    return s;
  }
  GaussianBeam(const Teuchos::ParameterList&, const NoContext&) {}
};
KILN_REGISTER(Source, GaussianBeam, "gaussian lamp", "A moving laser");

class Uniform : public Source {
 public:
  static Specification specification() {
    Specification s;
    s.real("conductance", "of the wall").unit("W/(m K)").defaults_to(25);
    return s;
  }
  Uniform(const Teuchos::ParameterList&, const NoContext&) {}
};
KILN_REGISTER(Source, Uniform, "uniform", "The same everywhere");

class Fields : public Watcher {
 public:
  static Specification specification() {
    Specification s;
    s.integer("every", "steps between two").at_least(1).defaults_to(1);
    return s;
  }
  Fields(const Teuchos::ParameterList&, const NoContext&) {}
};
KILN_REGISTER(Watcher, Fields, "frames", "Writes the state");

class PointProbes : public Watcher {
 public:
  static Specification specification() {
    Specification point;
    point.text("unit_of_value", "shown in the file").optional();
    point.text("name", "of the probe");
    point.reals("position", "where it lies").unit("m").length(3);
    Specification s;
    s.sections("points", "the probes", std::move(point));
    return s;
  }
  PointProbes(const Teuchos::ParameterList&, const NoContext&) {}
};
KILN_REGISTER(Watcher, PointProbes, "point probes", "Histories at points");

}  // namespace

Specification run_specification() {
  Specification model;
  model.real("spacing", "of the lattice").unit("m").above(0);
  model.real("temperature", "at the start").unit("K").at_least(0).defaults_to(293.15);
  model.real("porosity", "share of pores").at_least(0).at_most(1).defaults_to(0);
  model.reals("origin", "first corner").unit("m").length(3).defaults_to(std::vector<double>{0, 0, 0.5});
  model.integers("count", "particles a direction").length(2).at_least(1).optional();
  model.texts("tags", "words for the reader").optional();
  model.file("table", "of the material").optional();
  model.flag("periodic", "whether opposite faces are one").defaults_to(false);
  model.component<Kernel>("kernel", "smoothing kernel").defaults_to("conic spline");
  model.component<Source>("heat_source", "what heats the part");
  model.components<Source>("more_sources", "further ones").optional();

  Specification time;
  time.real("end", "of the run").unit("s").above(0).defaults_to(1);
  time.real("step", "of time").unit("s").above(0).at_most(0.5).defaults_to(0.1);
  time.integer("iterations", "cap a step").at_least(1).at_most(100).defaults_to(10);
  time.choice("jacobian", "its form", {"diagonal", "sparse"}).defaults_to("diagonal");
  time.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    if (list.get<double>("step") > list.get<double>("end")) {
      problems.push_back({"step", "the step is longer than the run", "at most 'end'", {}});
    }
  });

  Specification output;
  output.text("directory", "where files go").defaults_to("results");
  output.blocks<Watcher>("what is written");

  Specification run;
  run.text("title", "of the run").defaults_to("untitled: a run");
  run.section("model", "what is computed", std::move(model));
  run.section("time", "how it is stepped", std::move(time));
  run.section("output", "what is kept", std::move(output));
  return run;
}

}  // namespace kiln::test
