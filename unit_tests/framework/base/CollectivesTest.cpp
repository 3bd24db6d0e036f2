#include "framework/base/Collectives.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <string>

namespace kiln {
namespace {

const Communicator& world() {
  static const Teuchos::RCP<const Communicator> communicator = Tpetra::getDefaultComm();
  return *communicator;
}

/// More than one message holds, with a rest.
constexpr std::size_t long_count = 2 * (std::size_t{1} << 22) + 3;

TEST(InPieces, CoversEachElementOnce) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1} << 22, long_count}) {
    std::size_t end = 0;
    in_pieces(count, [&](std::size_t first, int length) {
      EXPECT_EQ(first, end);
      EXPECT_GT(length, 0);
      end += static_cast<std::size_t>(length);
    });
    EXPECT_EQ(end, count);
  }
}

TEST(Broadcast, GivesAllRanksTheRootsArrayWhateverLengthTheyHave) {
  for (int root = 0; root < world().getSize(); ++root) {
    const bool is_root = world().getRank() == root;
    std::string text = is_root ? "text of rank " + std::to_string(root) : std::string(world().getRank() * 20, 'x');
    broadcast(world(), root, text);
    EXPECT_EQ(text, "text of rank " + std::to_string(root));
    std::vector<double> nothing(is_root ? 0 : 5);
    broadcast(world(), root, nothing);
    EXPECT_TRUE(nothing.empty());
  }
}

TEST(Broadcast, MovesMoreThanOneMessageHolds) {
  const int root = world().getSize() - 1;
  std::vector<char> found(world().getRank() == root ? long_count : 0);
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = static_cast<char>(i % 101);
  broadcast(world(), root, found);
  ASSERT_EQ(found.size(), long_count);
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], static_cast<char>(i % 101)) << i;
}

/// Rank r brings r ids from 100 r on, so that rank 0 brings none.
TEST(Gathered, KeepsTheOrderOfTheRanks) {
  const auto ids_of = [](int rank) {
    std::vector<GlobalIndex> ids;
    for (int i = 0; i < rank; ++i) ids.push_back(100 * rank + i);
    return ids;
  };
  std::vector<std::vector<GlobalIndex>> each;
  std::vector<GlobalIndex> all;
  for (int rank = 0; rank < world().getSize(); ++rank) {
    each.push_back(ids_of(rank));
    all.insert(all.end(), each.back().begin(), each.back().end());
  }
  const std::vector<GlobalIndex> own = ids_of(world().getRank());
  EXPECT_EQ(gathered(world(), own), each);
  EXPECT_EQ(concatenated(world(), own), all);
}

}  // namespace
}  // namespace kiln
