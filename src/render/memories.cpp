#include "render/memories.h"

#include <utility>

namespace montelux {

std::shared_ptr<const ChainMemory> MemoryExchange::take(std::size_t number) {
  if (!settings_.memories || number >= settings_.memories->size()) return nullptr;
  return std::move((*settings_.memories)[number]);
}

void MemoryExchange::store(std::size_t number, Chain& chain, int frames) {
  if (!settings_.memories) return;
  if (settings_.memories->size() <= number) settings_.memories->resize(number + 1);
  if (settings_.max_memory == 0) return;
  std::shared_ptr<const ChainMemory> memory = chain.remember(frames);
  const std::size_t bytes = memory ? memory->bytes() : 0;
  if (bytes_ + bytes > settings_.max_memory) {
    ++forgotten_;
    return;
  }
  bytes_ += bytes;
  (*settings_.memories)[number] = std::move(memory);
}

void MemoryExchange::keep_first(std::size_t chains) {
  if (settings_.memories && settings_.memories->size() > chains) settings_.memories->resize(chains);
}

}  // namespace montelux
