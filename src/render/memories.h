// What the series of one image of a sequence keep for the next image.
#pragma once
#include <memory>
#include <vector>

#include "integrator/integrator.h"

namespace montelux {

// By the number of the series in the render; null: that series kept nothing.
using SeriesMemories = std::vector<std::shared_ptr<const SeriesMemory>>;

struct SequenceSettings {
  // Each series begins with the memory at its number and replaces it with its own at its end. Null: the image is not
  // part of a sequence.
  SeriesMemories* memories = nullptr;
  // Bytes of all memories together; series beyond this store none. 0: none are stored, for the last image.
  std::size_t max_memory = std::size_t(8) << 30;
};

// The memories of one render.
class MemoryExchange {
 public:
  explicit MemoryExchange(const SequenceSettings& settings) : settings_(settings) {}
  // Removes the memory from the list, so that it is deleted together with the series that uses it.
  std::shared_ptr<const SeriesMemory> take(std::size_t number);
  // Ends the series after so many whole frames.
  void store(std::size_t number, FrameSeries& series, int frames);
  // Deletes memories of an earlier image whose series this one did not have.
  void keep_first(std::size_t series);
  int forgotten() const { return forgotten_; }  // series whose memory did not fit

 private:
  const SequenceSettings& settings_;
  std::size_t bytes_ = 0;
  int forgotten_ = 0;
};

}  // namespace montelux
