#include "render/memories.h"

#include <utility>

namespace montelux {

std::shared_ptr<const SeriesMemory> MemoryExchange::take(std::size_t number) {
  if (!settings_.memories || number >= settings_.memories->size()) return nullptr;
  return std::move((*settings_.memories)[number]);
}

void MemoryExchange::store(std::size_t number, FrameSeries& series, int frames) {
  if (!settings_.memories) return;
  if (settings_.memories->size() <= number) settings_.memories->resize(number + 1);
  if (settings_.max_memory == 0) return;
  std::shared_ptr<const SeriesMemory> memory = series.remember(frames);
  const std::size_t bytes = memory ? memory->bytes() : 0;
  if (bytes_ + bytes > settings_.max_memory) {
    ++forgotten_;
    return;
  }
  bytes_ += bytes;
  (*settings_.memories)[number] = std::move(memory);
}

void MemoryExchange::keep_first(std::size_t series) {
  if (settings_.memories && settings_.memories->size() > series) settings_.memories->resize(series);
}

}  // namespace montelux
