// What the chains of one image of a sequence keep for the next image.
#pragma once
#include <memory>
#include <vector>

#include "integrator/integrator.h"

namespace montelux {

// By the number of the chain in the render; null: that chain kept nothing.
using ChainMemories = std::vector<std::shared_ptr<const ChainMemory>>;

struct SequenceSettings {
  // Each chain begins with the memory at its number and replaces it with its own at its end. Null: the image is not
  // part of a sequence.
  ChainMemories* memories = nullptr;
  // Bytes of all memories together; chains beyond this store none. 0: none are stored, for the last image.
  std::size_t max_memory = std::size_t(8) << 30;
};

// The memories of one render.
class MemoryExchange {
 public:
  explicit MemoryExchange(const SequenceSettings& settings) : settings_(settings) {}
  // Removes the memory from the list, so that it is deleted together with the chain that uses it.
  std::shared_ptr<const ChainMemory> take(std::size_t number);
  // Ends the chain after so many whole frames.
  void store(std::size_t number, Chain& chain, int frames);
  // Deletes memories of an earlier image whose chains this one did not have.
  void keep_first(std::size_t chains);
  int forgotten() const { return forgotten_; }  // chains whose memory did not fit

 private:
  const SequenceSettings& settings_;
  std::size_t bytes_ = 0;
  int forgotten_ = 0;
};

}  // namespace montelux
