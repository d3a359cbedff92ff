// What a contact remembers, in arrays of pairs and in checkpoints.

#include "src/solids/pair_histories.hpp"

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

const ContactHistory kSome{{1, 2, 3}, {4, 5, 6}, 0.5, -0.25};

TEST(PairHistories, KeepEachPart) {
  EXPECT_EQ(PairHistoryBuffers::kBytes, 1 + 8 * sizeof(Real));
  PairHistoryBuffers buffers;
  buffers.assign({kSome, {}});
  const std::vector<ContactHistory> all = buffers.to_host();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].xi, kSome.xi);
  EXPECT_EQ(all[0].couple, kSome.couple);
  EXPECT_EQ(all[0].overlap, 0.5);
  EXPECT_EQ(all[0].recede, -0.25);
  EXPECT_EQ(all[1].overlap, 0);

  PairHistoryBuffers other;
  other.swap(buffers);
  EXPECT_EQ(other.to_host()[0].xi, all[0].xi);
  EXPECT_TRUE(buffers.to_host().empty());
  other.reset(3);
  for (const ContactHistory& h : other.to_host()) EXPECT_EQ(h.overlap, 0);
}

TEST(PairHistories, DescribeTheColumnsOfCheckpoints) {
  EXPECT_EQ(ContactHistory::units(), "m, N m, m, m/s");
  EXPECT_EQ(WallMemory::units(), "-, -, m, N m, m, m/s");
  EXPECT_EQ(FileType<ContactHistory>::components, 8);
  EXPECT_EQ(FileType<WallMemory>::components, 12);
}

/// A version that remembers something else does not take these numbers for its own.
TEST(PairHistories, OfOtherQuantitiesAreRefused) {
  GrainBench bench;
  bench.add({}), bench.add({0.99 * 2.7e-3, 0, 0});
  bench.start();
  HostStore contacts = bench.solver->save_contacts(*bench.grains);
  ASSERT_EQ(contacts.count, 1u);
  EXPECT_NO_THROW(bench.solver->load_contacts(*bench.grains, *bench.grid, contacts));
  for (HostArray& array : contacts.arrays)
    if (array.name == "history") array.unit = "m, N m, m, J";
  EXPECT_THROW(bench.solver->load_contacts(*bench.grains, *bench.grid, contacts), FileError);
}

}  // namespace
}  // namespace BL_SOLVER
