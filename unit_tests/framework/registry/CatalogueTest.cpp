#include <gtest/gtest.h>

#include "framework/base/Units.hpp"
#include "framework/registry/Library.hpp"
#include "unit_tests/framework/input/TestComponents.hpp"

namespace kiln::test {
namespace {

TEST(Catalogue, KnowsWhatWasRegistered) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(catalogue::names("test kernel"), (Names{"conic spline", "wendland c9"}));
  EXPECT_EQ(catalogue::names("test source"), (Names{"gaussian lamp", "uniform"}));
  EXPECT_EQ(catalogue::names("test watcher"), (Names{"frames", "point probes"}));
  EXPECT_EQ(catalogue::names("nothing"), Names{});
  EXPECT_EQ(catalogue::find("test kernel", "wendland c9", "").summary, "Compactly supported polynomial");
}

TEST(Catalogue, RefusesANameTwice) {
  Registration again{Kernel::category, "conic spline", "once more", nullptr, "Again.cpp", 7, {}, {}, {}};
  const int line = catalogue::find(Kernel::category, "conic spline", "").line;
  try {
    catalogue::add(again);
    ADD_FAILURE() << "the second registration was taken";
  } catch (const std::logic_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("test kernel 'conic spline' is registered twice: "), std::string::npos) << text;
    EXPECT_NE(text.find("TestComponents.cpp:" + std::to_string(line) + " and Again.cpp:7"), std::string::npos) << text;
  }
  EXPECT_EQ(catalogue::names(Kernel::category).size(), 2u);
}

Specification no_keys() { return {}; }

Registration kernel_of_a_plugin(const char* name, int line) {
  return {Kernel::category, name, "from outside", &no_keys, "Plugin.cpp", line, {}, {}, {}};
}

TEST(Catalogue, KnowsWhichPluginAComponentCameWith) {
  catalogue::set_library("/there/plugin.so");
  catalogue::add(kernel_of_a_plugin("outer spline", 3));
  EXPECT_EQ(catalogue::end_library(false), std::vector<std::string>{});
  EXPECT_EQ(catalogue::find(Kernel::category, "outer spline", "").library, "/there/plugin.so");
  EXPECT_EQ(catalogue::find(Kernel::category, "conic spline", "").library, "");
  // A library that fails after all takes its components along, and no others.
  catalogue::set_library("/there/plugin.so");
  EXPECT_EQ(catalogue::end_library(true), std::vector<std::string>{});
  EXPECT_EQ(catalogue::names(Kernel::category), (std::vector<std::string>{"conic spline", "wendland c9"}));
}

TEST(Catalogue, APluginWithATakenNameLeavesNothingBehind) {
  catalogue::set_library("/there/plugin.so");
  catalogue::add(kernel_of_a_plugin("outer spline", 3));
  EXPECT_NO_THROW(catalogue::add(kernel_of_a_plugin("wendland c9", 4)));
  const std::vector<std::string> clashes = catalogue::end_library(false);
  ASSERT_EQ(clashes.size(), 1u);
  EXPECT_NE(clashes[0].find("test kernel 'wendland c9' is registered twice: "), std::string::npos) << clashes[0];
  EXPECT_NE(clashes[0].find("TestComponents.cpp:"), std::string::npos) << clashes[0];
  EXPECT_NE(clashes[0].find("/there/plugin.so (Plugin.cpp:4)"), std::string::npos) << clashes[0];
  EXPECT_EQ(catalogue::names(Kernel::category), (std::vector<std::string>{"conic spline", "wendland c9"}));
  EXPECT_THROW(catalogue::add(kernel_of_a_plugin("wendland c9", 4)), std::logic_error) << "Kiln's own again";
}

TEST(Catalogue, SuggestsTheNearestName) {
  try {
    catalogue::find("test kernel", "conic splien", "model.kernel");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "model.kernel: there is no test kernel 'conic splien'; expected one of: conic spline, wendland c9; did "
        "you mean 'conic spline'?");
  }
}

void expect_coherent_units(const Specification& specification, const std::string& owner) {
  for (const auto& entry : specification.entries()) {
    const Unit unit = parse_unit(entry->unit);
    EXPECT_TRUE(unit.exponent == 0 && unit.factor == 1 && unit.offset == 0)
        << owner << "." << entry->key << ": " << entry->unit << " is no unit of the SI without a prefix";
    EXPECT_FALSE(entry->help.empty()) << owner << "." << entry->key;
    if (entry->nested) expect_coherent_units(*entry->nested, owner + "." + entry->key);
  }
}

TEST(Catalogue, AllEntriesHaveHelpAndUnitsOfTheSi) {
  for (const Registration* registration : catalogue::all()) {
    expect_coherent_units(registration->specification(), registration->category + " " + registration->name);
  }
  expect_coherent_units(run_specification(), "run");
}

}  // namespace
}  // namespace kiln::test
