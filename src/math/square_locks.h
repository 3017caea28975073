// Locks for a grid of cells that many threads change.
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>

namespace montelux {

// One lock for each square of cells. A lock costs as much as one or two atomic additions, and serves all that is
// changed in a square at once.
class SquareLocks {
 public:
  // Of cells 0 <= x < width, 0 <= y < height.
  SquareLocks(int width, int height)
      : across_((width + side - 1) / side),
        locks_(std::make_unique<std::mutex[]>(std::size_t(across_) * std::size_t((height + side - 1) / side))) {}

  // Calls change() while no other thread changes a cell of x0 <= x <= x1, y0 <= y <= y1. Locks are taken in the order
  // of the squares, so that threads never wait for each other in a circle.
  template <class Change>
  void lock_and(int x0, int y0, int x1, int y1, Change change) {
    const Held held(*this, {x0 / side, y0 / side, x1 / side, y1 / side});
    change();
  }

 private:
  static constexpr int side = 16;
  // Squares, the last ones included.
  struct Range {
    int x0, y0, x1, y1;
  };
  class Held {
   public:
    Held(SquareLocks& all, const Range& range) : all_(all), range_(range) {
      for_each([](std::mutex& lock) { lock.lock(); });
    }
    ~Held() {
      for_each([](std::mutex& lock) { lock.unlock(); });
    }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

   private:
    template <class Function>
    void for_each(Function f) const {
      for (int y = range_.y0; y <= range_.y1; ++y)
        for (int x = range_.x0; x <= range_.x1; ++x)
          f(all_.locks_[std::size_t(y) * std::size_t(all_.across_) + std::size_t(x)]);
    }
    SquareLocks& all_;
    const Range range_;
  };

  int across_;
  std::unique_ptr<std::mutex[]> locks_;
};

}  // namespace montelux
