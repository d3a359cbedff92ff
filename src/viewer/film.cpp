#include "film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/viewer/picture.hpp"

namespace bedload {
namespace {

constexpr int kFrames = 40;     // after the first one
constexpr int kInterval = 100;  // ms
constexpr int kColumns = 3, kRows = 2;
constexpr PictureSize kSize{.width = 640, .height = 400, .fine = 2};
constexpr int kTitle = 34, kMargin = 10;  // pixels above the picture, and beside the text
constexpr Colour kInk{0.15f, 0.17f, 0.2f};

}  // namespace

Film::Film(const Config& config, double end)
    : title_(config.title), every_(end / kFrames), taker_(config), picture_(config), animation_(kInterval) {}

void Film::after_step(Simulation& simulation) {
  if (simulation.time() < due_) return;
  due_ = every_ * (std::floor(simulation.time() / every_) + 1);
  due_ -= 1e-9 * every_;  // the last one is at the end
  Image frame(kSize.width, kTitle + kSize.height, kPaper);
  const int digits = std::max(0, int(std::ceil(-std::log10(every_))) + 1);
  const std::string time = fmt::format("t = {:.{}f} s", simulation.time(), digits);
  frame.put(picture_.draw(taker_.take(simulation), LiveSide::oblique, kSize), 0, kTitle);
  frame.text(kMargin, kMargin, title_, kInk);
  frame.text(kSize.width - kMargin - text_width(time), kMargin, time, kInk);
  animation_.add(frame);
  if (frames_++ % (kFrames / (kColumns * kRows - 1)) == 0) sheet_.push_back(std::move(frame));
}

void Film::write(const std::filesystem::path& folder) const {
  if (sheet_.empty()) return;
  animation_.write(folder / "film.png");
  const int width = sheet_.front().width(), height = sheet_.front().height();
  Image sheet(kColumns * width, kRows * height, kPaper);
  for (int k = 0; k < int(sheet_.size()); ++k)
    sheet.put(sheet_[std::size_t(k)], k % kColumns * width, k / kColumns * height);
  sheet.write_png(folder / "picture.png");
}

}  // namespace bedload
