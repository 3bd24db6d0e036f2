#include "physics/sph/Particles.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "framework/files/Hdf5.hpp"
#include "framework/registry/Registry.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

ParticleCloud cloud_of(const Teuchos::ParameterList& list) {
  return Registry<Particles>::create(list, {Tpetra::getDefaultComm()})->cloud();
}

ParticleCloud lattice(std::array<int, 3> count, const std::string& placement) {
  HeatCase heat_case;
  heat_case.origin = {1.0, 2.0, 3.0};
  heat_case.size = {4.0, 3.0, 2.0};
  heat_case.count = count;
  heat_case.placement = placement;
  return cloud_of(heat_case.list().sublist("particles"));
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(Lattice, NodesLieOnTheFacesWithHalfAndQuarterAreas) {
  const ParticleCloud cloud = lattice({5, 4, 3}, "nodes");
  ASSERT_EQ(cloud.positions.size(), 60u);
  EXPECT_EQ(cloud.positions.front(), (Point{1.0, 2.0, 3.0}));
  EXPECT_EQ(cloud.positions[1], (Point{2.0, 2.0, 3.0}));
  EXPECT_EQ(cloud.positions[5], (Point{1.0, 3.0, 3.0}));
  EXPECT_EQ(cloud.positions.back(), (Point{5.0, 5.0, 5.0}));
  EXPECT_DOUBLE_EQ(cloud.spacing, 1.0);
  EXPECT_FALSE(cloud.faces);
  EXPECT_EQ(cloud.heated_areas[39], 0.0);
  EXPECT_DOUBLE_EQ(cloud.heated_areas[40], 0.25);
  EXPECT_DOUBLE_EQ(cloud.heated_areas[41], 0.5);
  EXPECT_DOUBLE_EQ(cloud.heated_areas[46], 1.0);
  EXPECT_DOUBLE_EQ(sum(cloud.heated_areas), 12.0);
  EXPECT_NEAR(sum(cloud.volumes), 24.0, 1e-12);
}

TEST(Lattice, CellsFillTheBox) {
  const ParticleCloud cloud = lattice({4, 2, 1}, "cells");
  ASSERT_EQ(cloud.positions.size(), 8u);
  EXPECT_EQ(cloud.positions.front(), (Point{1.5, 2.75, 4.0}));
  EXPECT_DOUBLE_EQ(cloud.spacing, 2.0);
  ASSERT_TRUE(cloud.faces);
  EXPECT_EQ(cloud.faces->upper, (Point{5.0, 5.0, 5.0}));
  EXPECT_DOUBLE_EQ(cloud.heated_areas[0], 1.5);
  EXPECT_DOUBLE_EQ(sum(cloud.heated_areas), 12.0);
}

class ParticleFileTest : public testing::Test {
 protected:
  ParticleCloud read(const std::string& name, const std::string& content, double volume = 0.0) {
    std::ofstream(folder_ / name) << content;
    return read(name, volume);
  }
  ParticleCloud read(const std::string& name, double volume = 0.0) {
    Teuchos::ParameterList list("model.particles");
    list.set("type", std::string("file")).set("path", folder_ / name).set("spacing", 0.1);
    if (volume > 0.0) list.set("volume", volume);
    return cloud_of(list);
  }
  template <class Error>
  std::string message(const std::string& content) {
    try {
      read("particles.csv", content, 0.0);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing was thrown";
  }
  TestFolder folder_;
};

TEST_F(ParticleFileTest, CsvWithAllColumns) {
  const ParticleCloud cloud = read("a.csv", "x, area,y,z,volume\n# a comment\n0,0.5,1,2,3e-3\r\n\n4, 0, 5,6,7e-3\n");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[1], (Point{4.0, 5.0, 6.0}));
  EXPECT_EQ(cloud.volumes, (std::vector<double>{3e-3, 7e-3}));
  EXPECT_EQ(cloud.heated_areas, (std::vector<double>{0.5, 0.0}));
  EXPECT_FALSE(cloud.faces);
}

TEST_F(ParticleFileTest, VolumeOfThePartIsShared) {
  const ParticleCloud cloud = read("a.csv", "x,y,z\n0,0,0\n1,0,0\n", 6.0);
  EXPECT_EQ(cloud.volumes, (std::vector<double>{3.0, 3.0}));
  EXPECT_EQ(cloud.heated_areas, (std::vector<double>{0.0, 0.0}));
}

TEST_F(ParticleFileTest, Hdf5) {
  {
    hdf5::File file = hdf5::File::create(folder_ / "a.h5", Tpetra::getDefaultComm());
    file.write("x", std::vector<double>{0.0, 1.0, 2.0});
    file.write("y", std::vector<double>{0.0, 0.0, 0.5});
    file.write("z", std::vector<double>{3.0, 4.0, 5.0});
    file.write("area", std::vector<double>{0.0, 0.0, 0.1});
  }
  const ParticleCloud cloud = read("a.h5", 3.0);
  EXPECT_EQ(cloud.positions[2], (Point{2.0, 0.5, 5.0}));
  EXPECT_EQ(cloud.heated_areas[2], 0.1);
  EXPECT_EQ(cloud.volumes[0], 1.0);
}

TEST_F(ParticleFileTest, MistakesNameTheLine) {
  EXPECT_NE(message<FileError>("x,y\n1,2\n").find("line 1: column 'z' is missing"), std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,mass\n").find("line 1: column 'mass' is not known"), std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,volume\n0,0,0,1\n1,2,3\n").find("line 3: 3 values; expected 4"),
            std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,volume\n0,0,0,1\n1,nan,3,1\n").find("line 3, column 'y': 'nan' is not a finite"),
            std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,volume\n0,0,0,1\n1,1,3e,1\n").find("'3e' is not a finite number"),
            std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,volume\n0,0,0,-1\n").find("line 2: the volume is -1"), std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z,volume,area\n0,0,0,1,-2\n").find("line 2: the area is -2"), std::string::npos);
  EXPECT_NE(message<FileError>("x,y,z\n").find("has no line of numbers"), std::string::npos);
  EXPECT_NE(message<InputError>("x,y,z\n0,0,0\n").find("model.particles.volume: is missing, and "), std::string::npos);
  try {
    read("missing.csv");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("missing.csv"), std::string::npos);
  }
}

}  // namespace
}  // namespace kiln
