// What a contact remembers, in arrays of pairs and in checkpoints.

#include "src/solids/pair_histories.hpp"

#include "tests/support/contact_law.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

ContactLaw law_of(SlidingLaw sliding, RollingLaw rolling) {
  GrainBench bench;
  bench.config.contact.tangential = sliding;
  bench.config.contact.rolling = rolling;
  bench.config.grain.mu_r = 0.1;
  return contact_law_of(bench.config);
}

const ContactHistory kSome{{1, 2, 3}, {4, 5, 6}, 0.5, -0.25};

TEST(PairHistories, KeepTheirPartsByTheLaws) {
  struct Case {
    SlidingLaw sliding;
    RollingLaw rolling;
    bool spring, couple;
  };
  for (const Case& c : {Case{SlidingLaw::none, RollingLaw::none, false, false},
                        Case{SlidingLaw::mindlin, RollingLaw::none, true, false},
                        Case{SlidingLaw::mindlin, RollingLaw::cdt, true, false},
                        Case{SlidingLaw::none, RollingLaw::epsd, false, true},
                        Case{SlidingLaw::mindlin, RollingLaw::epsd, true, true}}) {
    PairHistoryBuffers buffers({law_of(c.sliding, c.rolling)});
    EXPECT_EQ(buffers.entry_bytes(), 1 + 2 * sizeof(Real) + (c.spring + c.couple) * sizeof(Vec3d));
    buffers.assign({kSome, {}});
    const std::vector<ContactHistory> all = buffers.to_host();
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].xi, c.spring ? kSome.xi : Vec3d{});
    EXPECT_EQ(all[0].couple, c.couple ? kSome.couple : Vec3d{});
    EXPECT_EQ(all[0].overlap, 0.5);
    EXPECT_EQ(all[0].recede, -0.25);
    EXPECT_EQ(all[1].overlap, 0);

    PairHistoryBuffers other({law_of(c.sliding, c.rolling)});
    other.swap(buffers);
    EXPECT_EQ(other.to_host()[0].xi, all[0].xi);
    EXPECT_TRUE(buffers.to_host().empty());
    other.reset(3);
    for (const ContactHistory& h : other.to_host()) EXPECT_EQ(h.overlap, 0);
  }
}

/// Some pairs of materials may roll without friction, the first too.
TEST(PairHistories, KeepWhatAnyPairOfMaterialsNeeds) {
  PairHistoryBuffers buffers(
      {law_of(SlidingLaw::mindlin, RollingLaw::none), law_of(SlidingLaw::mindlin, RollingLaw::epsd)});
  buffers.assign({kSome});
  EXPECT_EQ(buffers.to_host()[0].couple, kSome.couple);
}

TEST(PairHistories, DescribeTheColumnsOfCheckpoints) {
  EXPECT_EQ(HistoryParts::units(), "m, N m, m, m/s");
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
