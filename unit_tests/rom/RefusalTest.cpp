#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "Projections.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Seal.hpp"
#include "framework/method/Trainer.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using test::Case;
using test::world;

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// One trained file, of which each test spoils its own copy.
class Refusal : public testing::Test {
 protected:
  Refusal() {
    values_.folder = folder_.path().string();
    values_.jacobian = "diagonal";
    values_.tolerance = 1e-6;
    train(values_);
    file_ = values_.folder + "/reduction.h5";
  }

  static void train(const Case& values) {
    const Teuchos::ParameterList input = test::input_of(values);
    RunReport report;
    Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, world()})
        ->train(values.folder + "/reduction.h5", report);
  }

  /// What opening says for a method and an input; changes are made to the checked input itself.
  std::string opening(const std::string& method,
                      const std::function<void(Teuchos::ParameterList&)>& change = {}) const {
    Case values = values_;
    values.method = method;
    Teuchos::ParameterList input = test::input_of(values);
    if (change) change(input);
    return message([&] { Registry<Method>::create(input.sublist("method"), Method::Context{input, world()}); });
  }

  void spoil(const std::function<void(hdf5::File&)>& change) const {
    {
      hdf5::File file = hdf5::File::modify(file_, world());
      change(file);
    }
    hdf5::seal(file_, *world());
  }

  /// Removes an object by its path; on rank 0 alone, through HDF5 itself.
  void remove(const std::string& object) const {
    world()->barrier();
    if (world()->getRank() == 0) {
      const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      ASSERT_GE(H5Ldelete(file, object.c_str(), H5P_DEFAULT), 0);
      H5Fclose(file);
    }
    hdf5::seal(file_, *world());
  }

  TestFolder folder_;
  Case values_;
  std::string file_;
};

TEST_F(Refusal, OpensWhatBelongsTogether) {
  for (const char* method : {"galerkin", "lspg", "gnat"}) EXPECT_EQ(opening(method), "nothing was thrown");
  // Live parameters may differ, and time stepping may where no residual basis was learnt with it.
  const auto hotter = [](Teuchos::ParameterList& input) { input.sublist("model").set("power", 50.0); };
  const auto slower = [](Teuchos::ParameterList& input) { input.sublist("time").set("step", 0.001); };
  EXPECT_EQ(opening("gnat", hotter), "nothing was thrown");
  EXPECT_EQ(opening("lspg", slower), "nothing was thrown");
}

TEST_F(Refusal, AnotherModel) {
  const auto reaction = [](Teuchos::ParameterList& input) { input.sublist("model").set("reaction", 3.0); };
  const std::string expected = file_ +
                               ": belongs to another model: model.reaction: the reduction has '2', this input '3'; "
                               "expected the model it was trained for; or train again";
  for (const char* method : {"galerkin", "lspg", "gnat"}) EXPECT_EQ(opening(method, reaction), expected);
}

TEST_F(Refusal, AnotherModelInManyEntries) {
  EXPECT_EQ(
      opening("gnat",
              [](Teuchos::ParameterList& input) {
                Teuchos::ParameterList& model = input.sublist("model");
                model.set("count", 61);
                model.set("reaction", 1.0);
                model.set("colour", std::string("red"));
                model.set("shade", std::string("dark"));
                model.set("power", 1.0);
              }),
      file_ +
          ": belongs to another model: model.count: the reduction has '60', this input '61'; model.reaction: the "
          "reduction has '2', this input '1'; model.colour: the reduction has none, this input 'red'; and 1 more; "
          "expected the model it was trained for; or train again");
}

TEST_F(Refusal, AnotherTimeStepping) {
  EXPECT_EQ(
      opening("gnat",
              [](Teuchos::ParameterList& input) {
                input.sublist("time").set("step", 0.001);
                input.sublist("time").sublist("scheme").set("type", std::string("bdf2"));
              }),
      file_ +
          ": was trained with another time stepping: time.step: the reduction has '0.002 s', this input '0.001 s'; "
          "time.scheme.type: the reduction has 'backward euler', this input 'bdf2'; expected the step and scheme it "
          "was trained with; or train again");
}

TEST_F(Refusal, AMissingFile) {
  world()->barrier();
  if (world()->getRank() == 0) std::filesystem::remove(file_);
  world()->barrier();
  EXPECT_EQ(opening("gnat"), file_ + ": there is no such file; expected a reduction; `kiln train` writes it");
}

TEST_F(Refusal, AFileThatIsNoReduction) {
  { hdf5::File::create(file_, world()).write("numbers", std::vector<double>{1.0}); }
  EXPECT_EQ(opening("lspg"), file_ + ": is an HDF5 file, but not a reduction; expected a file written by `kiln train`");
}

TEST_F(Refusal, AFileThatIsNotHdf5) {
  world()->barrier();
  if (world()->getRank() == 0) std::ofstream(file_) << "model: red\n";
  world()->barrier();
  EXPECT_EQ(opening("gnat"), file_ + ": is not an HDF5 file; expected a file that begins with HDF5's signature");
}

TEST_F(Refusal, ATruncatedFile) {
  world()->barrier();
  const auto size = std::filesystem::file_size(file_);
  world()->barrier();
  if (world()->getRank() == 0) std::filesystem::resize_file(file_, size / 2);
  world()->barrier();
  const std::string start =
      fmt::format("{}: cannot be read (truncated file: eof = {}, sblock->base_addr = 0", file_, size / 2);
  EXPECT_EQ(opening("gnat").substr(0, start.size()), start);
}

TEST_F(Refusal, AnotherFormatVersion) {
  spoil([](hdf5::File& file) { file.attribute("format_version", 7); });
  EXPECT_EQ(opening("gnat"), file_ + ": format_version: is 7; expected 4: train again with this version of Kiln");
}

TEST_F(Refusal, AFileThatLostItsSeal) {
  world()->barrier();
  const auto size = std::filesystem::file_size(file_);
  world()->barrier();
  if (world()->getRank() == 0) std::filesystem::resize_file(file_, size - 1);
  world()->barrier();
  EXPECT_EQ(opening("gnat"),
            file_ +
                ": carries no seal: it was cut short, changed, or written by another version of Kiln; expected the "
                "file as this version of Kiln wrote it");
}

/// Whatever byte is changed, and to whatever: the file is refused before HDF5 looks at it.
TEST_F(Refusal, AnyChangedByte) {
  const auto size = static_cast<long long>(std::filesystem::file_size(file_));
  for (long long k = 0; k < 40; ++k) {
    // Past the signature, in data and metadata alike, and in the seal.
    const long long place = 8 + (size - 9) * k / 39;
    char byte = 0;
    const auto exchange = [&](int mask) {
      world()->barrier();
      if (world()->getRank() == 0) {
        std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekg(place);
        file.get(byte);
        file.seekp(place);
        file.put(static_cast<char>(byte ^ mask));
      }
      world()->barrier();
    };
    exchange(0x10);
    const std::string told = opening("gnat");
    EXPECT_EQ(told.rfind(file_ + ": ", 0), 0u) << place << ": " << told;
    EXPECT_TRUE(told.find("is not what was written") != std::string::npos ||
                told.find("carries no seal") != std::string::npos)
        << place << ": " << told;
    exchange(0x10);
  }
  EXPECT_EQ(opening("gnat"), "nothing was thrown");
}

TEST_F(Refusal, NumbersOutOfBounds) {
  const auto refused = [this](const std::function<void(hdf5::File&)>& change, const std::string& words) {
    const std::string copy = folder_ / "copy.h5";
    world()->barrier();
    if (world()->getRank() == 0) std::filesystem::copy_file(file_, copy);
    spoil(change);
    const std::string told = opening("gnat");
    EXPECT_EQ(told.rfind(file_ + ": ", 0), 0u) << told;
    EXPECT_NE(told.find(words), std::string::npos) << words << ": " << told;
    world()->barrier();
    if (world()->getRank() == 0) std::filesystem::rename(copy, file_);
    world()->barrier();
  };
  const auto mesh = [](hdf5::File& file) { return file.group("windows").group("0").group("sample_mesh"); };
  refused([](hdf5::File& file) { file.attribute("components", 0); }, "attribute 'components': is 0; expected 1 to");
  refused([](hdf5::File& file) { file.attribute("components", 1LL << 40); },
          "attribute 'components': is 1099511627776");
  refused([](hdf5::File& file) { file.attribute("particles", -1); }, "attribute 'particles': is -1");
  refused([](hdf5::File& file) { file.attribute("particles", 3); }, "holds particle ");
  const auto rank = [](long long value) {
    return [value](hdf5::File& file) { file.group("windows").group("0").group("basis").attribute("rank", value); };
  };
  refused(rank(0), "attribute 'rank': is 0");
  refused(rank((1LL << 32) + 10), "attribute 'rank': is 4294967306");
  refused([&](hdf5::File& file) { mesh(file).attribute("residual_rank", 0); }, "attribute 'residual_rank': is 0");
  refused([&](hdf5::File& file) { file.group("windows").group("0").attribute("end", std::nan("")); },
          "attribute 'end': is nan");
}

/// What a sampled model reads must be finite.
TEST_F(Refusal, ValuesThatAreNotFinite) {
  const hdf5::Array<double> old = hdf5::File::read(file_, world()).group("particles").reals("modes");
  remove("/particles/modes");
  spoil([&](hdf5::File& file) {
    hdf5::Array<double> modes = old;
    modes.values[3] = std::nan("");
    file.group("particles").write("modes", modes);
  });
  EXPECT_EQ(opening("gnat"), file_ + ": /particles/modes: value 3 is nan; expected finite numbers");
}

TEST_F(Refusal, AChangedModelInput) {
  spoil([](hdf5::File& file) { file.attribute("model_input", "type: test chain\n"); });
  EXPECT_EQ(opening("gnat"), file_ + ": model_input: does not match its hash: the file was changed after training");
}

TEST_F(Refusal, AWindowWithoutABasis) {
  spoil([](hdf5::File& file) { file.group("windows").create_group("1").attribute("end", 1.0); });
  EXPECT_EQ(opening("gnat"), file_ + ": /windows/1/basis: is missing; expected a group");
}

TEST_F(Refusal, WindowsOutOfOrder) {
  spoil([](hdf5::File& file) { file.group("windows").create_group("1").attribute("end", 0.01); });
  // What a window needs is looked at first to last, so that the end is what is named.
  spoil([](hdf5::File& file) { file.group("windows").group("1").create_group("basis").attribute("rank", 3LL); });
  EXPECT_EQ(opening("gnat"), file_ +
                                 ": /windows/1, attribute end: 0.01 s; expected a time after 0.08 s, where the window "
                                 "begins");
}

TEST_F(Refusal, AMissingDataset) {
  remove("/windows/0/sample_mesh/gappy_operator");
  EXPECT_EQ(opening("gnat"), file_ + ": /windows/0/sample_mesh/gappy_operator: is missing; expected a dataset");
  EXPECT_EQ(opening("lspg"), "nothing was thrown");
  remove("/windows/0/basis/modes");
  EXPECT_EQ(opening("lspg"), file_ + ": /windows/0/basis/modes: is missing; expected a dataset");
}

TEST_F(Refusal, AWrongRank) {
  spoil([](hdf5::File& file) { file.group("windows").group("0").group("basis").attribute("rank", 11); });
  EXPECT_EQ(opening("lspg"), file_ + ": /windows/0/basis/modes: has 10 columns; expected 11, its rank");
  const std::string message = opening("gnat");
  EXPECT_EQ(message.rfind(file_ + ": /particles/modes: has shape ", 0), 0u) << message;
  EXPECT_NE(message.find(" × 10; expected shape "), std::string::npos) << message;
  EXPECT_NE(message.find(" × 11"), std::string::npos) << message;
}

TEST_F(Refusal, ASampledModelThatIsNotTheMeshs) {
  remove("/windows/0/sample_mesh/model/rows");
  spoil([](hdf5::File& file) {
    hdf5::Group model = file.group("windows").group("0").group("sample_mesh").group("model");
    model.write("rows", std::vector<long long>{0, 1});
  });
  EXPECT_EQ(opening("gnat"), file_ + ": windows/0: its sampled model has 2 rows; expected the 24 of sample_mesh/rows");
}

TEST_F(Refusal, TrainingThatAsksForTooMuch) {
  Case greedy = values_;
  greedy.samples = 5;
  EXPECT_EQ(
      message([&] { train(greedy); }),
      "reduction.sampling.samples: 5 particles with 1 component each cannot determine 12 residual modes; expected "
      "at least 12");
  greedy.samples = 100;
  EXPECT_EQ(message([&] { train(greedy); }),
            "reduction.sampling.samples: 100 particles are asked for; expected at most the model's 60");
  Case wide = values_;
  wide.basis_rank = 50;
  EXPECT_EQ(message([&] { train(wide); }),
            "reduction.basis.rank: 50 basis vectors are more than the 40 snapshots that are held; expected at most 40, "
            "or a smaller snapshots.every");
  wide.basis_rank = wide.residual_rank = wide.samples = 40;
  EXPECT_EQ(message([&] {
              train(wide);
            }).rfind("reduction.basis.rank: 40 basis vectors are asked for, but of 40 snapshots only ", 0),
            0u);
  // The earlier file is still whole.
  EXPECT_EQ(opening("gnat"), "nothing was thrown");
}

TEST_F(Refusal, AFileNamedByTheMethodIsTaken) {
  world()->barrier();
  if (world()->getRank() == 0) std::filesystem::rename(file_, folder_ / "other.h5");
  world()->barrier();
  EXPECT_EQ(
      opening("gnat",
              [this](Teuchos::ParameterList& input) { input.sublist("method").set("file", folder_ / "other.h5"); }),
      "nothing was thrown");
}

}  // namespace
}  // namespace kiln
