// What the readers of scene files have in common.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/environment.h"
#include "parameter/diagnostic.h"
#include "scene/description.h"

namespace montelux {

// The time of an animation as stated by a file.
struct AnimationTime {
  double start = 0, end = 0;  // in its own unit, s in glTF
  double frame_rate = 24;     // default
};

// The part of an animation's time that images need: times at the ends of equal intervals and, if the shutter is
// open, between them. Empty: only the start.
struct AnimationWindow {
  double start = 0, end = 0;
  int intervals = 1;
  bool open = false;
  double exposure = 0;  // of one image of a sequence, in intervals
};

struct ReadOptions {
  // Unknown parameters and features that are not supported yet (motion, media, some materials) are warnings instead of
  // errors; substitutes are used.
  bool lenient = false;
  // For a file with several cameras: the name or the number of one; default: the first.
  std::optional<std::string> camera{};
  // For a file with several animations: the name or the number of one; default: the first.
  std::optional<std::string> animation{};
  // The part of the animation that is needed; default: its beginning, as a still image.
  std::function<AnimationWindow(const AnimationTime&)> window{};
  // Replaces the scene's own.
  std::optional<Environment> environment{};
};

// What a lenient reading omitted from a scene or replaced.
struct Omission {
  std::string what;  // as in the warning that represents it among the diagnostics
  SourceLocation first;
  int count = 1;  // occurrences
};

// An animation and its length, in the file's unit of time.
struct NamedAnimation {
  std::string name;
  double seconds = 0;
};

// A scene, or no scene if there was an error. Diagnostics may contain warnings and notes in addition to a scene.
struct ReadResult {
  std::optional<SceneDesc> scene;
  Diagnostics diagnostics;
  std::vector<Omission> omissions{};  // in the order of their first positions
  // All of those in a file, rendered or not; a name may be empty.
  std::vector<std::string> cameras{};
  std::vector<NamedAnimation> animations{};
};

}  // namespace montelux
