#include "bedload/output/writer_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <vector>

namespace bedload {
namespace {

using namespace std::chrono_literals;

TEST(WriterThread, WorksInOrder) {
  std::vector<int> done;
  WriterThread writer(2);
  for (int k = 0; k < 100; ++k) writer.post([&, k] { done.push_back(k); });
  writer.drain();
  ASSERT_EQ(done.size(), 100u);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(done[k], k);
}

TEST(WriterThread, PosterWaitsOnceTheQueueIsFull) {
  std::atomic<bool> open = false;
  std::atomic<int> posted = 0;
  WriterThread writer(2);
  std::thread poster([&] {
    for (int k = 0; k < 5; ++k) {
      writer.post([&] {
        while (!open) std::this_thread::sleep_for(1ms);
      });
      ++posted;
    }
  });
  for (int k = 0; k < 10000 && posted < 2; ++k) std::this_thread::sleep_for(1ms);  // on a busy machine
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(posted, 2);
  open = true;
  poster.join();
  EXPECT_EQ(posted, 5);
}

TEST(WriterThread, LargeJobsAreWaitedForAlone) {
  std::atomic<bool> open = false, waited = false;
  WriterThread writer(100);
  for (int k = 0; k < 2; ++k)
    writer.post(
        [&] {
          while (!open) std::this_thread::sleep_for(1ms);
        },
        WriterThread::Size::large);
  for (int k = 0; k < 10; ++k) writer.post([] {});
  writer.wait_for_large(2);
  std::thread poster([&] {
    writer.wait_for_large(1);
    waited = true;
  });
  std::this_thread::sleep_for(50ms);
  EXPECT_FALSE(waited);
  open = true;
  poster.join();
  writer.drain();
  EXPECT_GT(writer.busy(), 0.02);
}

TEST(WriterThread, FirstErrorIsRethrownAndEndsTheWork) {
  bool later = false;
  WriterThread writer;
  writer.post([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(writer.drain(), std::runtime_error);
  EXPECT_THROW(writer.post([&] { later = true; }), std::runtime_error);
  EXPECT_THROW(writer.drain(), std::runtime_error);
  EXPECT_FALSE(later);
}

TEST(WriterThread, FinishesWhatWaitsWhenDestroyed) {
  int done = 0;
  {
    WriterThread writer(8);
    for (int k = 0; k < 8; ++k)
      writer.post([&] {
        std::this_thread::sleep_for(1ms);
        ++done;
      });
  }
  EXPECT_EQ(done, 8);
}

}  // namespace
}  // namespace bedload
