// Stores that grow and shrink.

#include "bedload/particles/store.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "bedload/parallel/compact.hpp"

namespace BL_SOLVER {
namespace {

struct Pairs : Store {
  Pairs() : Store("pairs") {}
  Field<Id> id{*this, "id", "-", Lifetime::kept};
  Field<Real> scratch{*this, "scratch", "-", Lifetime::derived};
};

struct NotThirds {
  Span<const Id> id;
  BL_HD bool operator()(Index i) const { return id[i] % 3 != 0; }
};

TEST(Store, GrowsAndKeepsWhatItHolds) {
  Pairs store;
  store.grow(3);
  store.id.assign({5, 6, 7});
  for (const Index n : {4u, 200u}) {
    store.grow(n);
    const auto id = store.id.values();
    ASSERT_EQ(id.size(), n);
    EXPECT_EQ(store.scratch.values().size(), n);
    for (Index i = 0; i < n; ++i) EXPECT_EQ(id[i], i < 3 ? 5 + i : 0);
  }
}

TEST(Store, SpendsNothingOnFieldsLeftOut) {
  Pairs store;
  store.id.leave_out();
  store.grow(3);
  store.resize(5);
  store.id.assign({5, 6, 7});
  EXPECT_EQ(store.id.span().size, 0u);
  EXPECT_EQ(store.scratch.span().size, 5u);
  EXPECT_TRUE(store.save().arrays.empty());
  store.load(store.save());
  Buffer<Index> kept;
  Buffer<Id> id;
  id.assign({1, 3, 2, 6, 5});
  find_all(store.size(), NotThirds{id}, kept);
  store.reorder(kept);
  EXPECT_EQ(store.size(), 3u);
}

TEST(Store, SortsWhatIsKeptAndSavesWhatIsRenewed) {
  struct Sorted : Store {
    Sorted() : Store("sorted") {}
    Field<Real> kept{*this, "kept", "-", Lifetime::kept}, second{*this, "second", "-", Lifetime::kept};
    Field<Real> carried{*this, "carried", "-", Lifetime::carried};
    Field<Real> renewed{*this, "renewed", "-", Lifetime::renewed};
    Field<Real> derived{*this, "derived", "-", Lifetime::derived};
  } store;
  store.grow(3);
  store.kept.assign({5, 6, 7}), store.second.assign({50, 60, 70}), store.carried.assign({1, 2, 3});
  store.renewed.assign({8, 8, 8}), store.derived.assign({9, 9, 9});
  Buffer<Index> order;
  order.assign({2, 0});
  store.reorder(order);
  EXPECT_EQ(store.kept.values(), (std::vector<Real>{7, 5}));
  EXPECT_EQ(store.second.values(), (std::vector<Real>{70, 50}));
  EXPECT_EQ(store.carried.values(), (std::vector<Real>{3, 1}));
  EXPECT_EQ(store.derived.values().size(), 2u);
  store.renewed.copy(store.kept);
  const HostStore saved = store.save();
  EXPECT_EQ(saved.arrays.size(), 3u);
  ASSERT_TRUE(saved.find("renewed"));
  store.renewed.assign({0, 0});
  store.load(saved);
  EXPECT_EQ(store.renewed.values(), (std::vector<Real>{7, 5}));
}

/// Another precision has other numbers, which must not be read as if they were this one's.
TEST(Store, RefusesArraysOfAnotherType) {
  struct Places : Store {
    Places() : Store("places") {}
    Field<Real> radius{*this, "radius", "m", Lifetime::kept};
    Field<Real3> v{*this, "v", "m/s", Lifetime::kept};
  } store;
  store.grow(2);
  const HostStore saved = store.save();
  const auto changed = [&](int k, Scalar type, int components) {
    HostStore other = saved;
    other.arrays[k].type = type, other.arrays[k].components = components;
    return other;
  };
  const Scalar own = saved.arrays[0].type, other = own == Scalar::f32 ? Scalar::f64 : Scalar::f32;
  EXPECT_NO_THROW(store.load(changed(0, own, 1)));
  EXPECT_THROW(store.load(changed(0, other, 1)), FileError);
  EXPECT_THROW(store.load(changed(1, other, 3)), FileError);
  EXPECT_THROW(store.load(changed(1, own, 4)), FileError);
  HostStore less = saved;
  less.arrays.pop_back();
  EXPECT_THROW(store.load(less), FileError);
}

TEST(Store, LosesWhatDoesNotStayAndGrowsAgain) {
  Pairs store;
  std::vector<Id> all(10000), left;
  std::iota(all.begin(), all.end(), Id(0));
  for (const Id k : all)
    if (k % 3 != 0) left.push_back(k);
  store.grow(Index(all.size()));
  store.id.assign(all);
  Buffer<Index> kept;
  find_all(store.size(), NotThirds{store.id}, kept);
  store.reorder(kept);
  EXPECT_EQ(store.size(), left.size());
  EXPECT_EQ(store.id.values(), left);
  store.grow(store.size() + 2);
  left.insert(left.end(), {0, 0});
  EXPECT_EQ(store.id.values(), left);
}

TEST(Store, NothingMayBeLeft) {
  Buffer<Index> kept;
  Buffer<Id> id;
  id.assign({0, 3, 6});
  find_all(3, NotThirds{id.span()}, kept);
  EXPECT_EQ(kept.size(), 0u);
  find_all(0, NotThirds{id.span()}, kept);
  EXPECT_EQ(kept.size(), 0u);
}

}  // namespace
}  // namespace BL_SOLVER
