// Blocks of host memory that are kept for the next frame.

#include "bedload/core/host_memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <thread>

namespace bedload {
namespace {

int made = 0, freed = 0;

class HostMemoryTest : public testing::Test {
 protected:
  void SetUp() override {
    made = freed = 0;
    HostMemory::use(
        [](std::size_t bytes) {
          ++made;
          return std::aligned_alloc(64, (bytes + 63) / 64 * 64);
        },
        [](void* block) {
          ++freed;
          std::free(block);
        });
  }
  void TearDown() override {
    HostMemory::use([](std::size_t bytes) { return std::aligned_alloc(64, (bytes + 63) / 64 * 64); },
                    std::free);
  }
};

TEST_F(HostMemoryTest, ABlockIsTakenAgain) {
  constexpr std::size_t n = 50'000'003;  // of no other test
  const std::size_t before = HostMemory::kept();
  const std::byte* first = nullptr;
  {
    const HostBytes bytes(n);
    first = bytes.data();
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(first) % 64, 0u);
    EXPECT_EQ(HostMemory::kept(), before);
  }
  EXPECT_GE(HostMemory::kept(), before + n);
  const HostBytes less(n - n / 10), beside(n);
  EXPECT_EQ(less.data(), first);
  EXPECT_NE(beside.data(), first);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(freed, 0);
}

TEST_F(HostMemoryTest, ContentsMoveBetweenThreads) {
  HostBytes bytes(1 << 20, std::byte(7));
  std::thread([moved = std::move(bytes)] { EXPECT_EQ(moved[(1 << 20) - 1], std::byte(7)); }).join();
  bytes.assign(100, std::byte(1));
  bytes.resize(1 << 20);
  EXPECT_EQ(bytes[99], std::byte(1));
  const HostBytes copy = bytes;
  EXPECT_TRUE(copy[99] == std::byte(1) && copy.data() != bytes.data());
}

TEST_F(HostMemoryTest, KeepsNoMoreThanItsLimit) {
  const std::size_t n = HostMemory::most_kept() / 3;
  {
    const HostBytes one(n), two(n), beyond(n);  // never written, so no memory is used
    EXPECT_LE(made, 2);
  }
  EXPECT_LE(HostMemory::kept(), HostMemory::most_kept());
  const int kept = made;
  { const HostBytes larger(2 * n); }
  EXPECT_EQ(made, kept + 1);
  EXPECT_GE(freed, 1) << "blocks that wait give way to one that does not fit them";
  EXPECT_LE(HostMemory::kept(), HostMemory::most_kept());
}

TEST_F(HostMemoryTest, TakesOrdinaryMemoryWhereTheDeviceHasNone) {
  HostMemory::use([](std::size_t) -> void* { return nullptr; }, [](void*) { ++freed; });
  {
    HostBytes bytes(33'000'001);
    bytes.back() = std::byte(1);
  }
  EXPECT_EQ(freed, 0);
  HostBytes none;
  EXPECT_THROW(none.resize(std::size_t(1) << 62), std::exception);
}

}  // namespace
}  // namespace bedload
