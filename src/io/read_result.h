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

// What a file says about the time of its animation.
struct AnimationTime {
  double start = 0, end = 0;  // in its own unit, s in glTF
  double frame_rate = 24;     // where nothing else is asked for
};

// The part of an animation's time that pictures need: moments at the ends of equal intervals, and, where the shutter is
// open, what lies between. Empty: the start alone.
struct AnimationWindow {
  double start = 0, end = 0;
  int intervals = 1;
  bool open = false;
  double exposure = 0;  // of one picture of a sequence, in intervals
};

struct ReadOptions {
  // Unknown parameters, and what Montelux cannot do yet (motion, media, some materials), are warnings instead of
  // errors; stand-ins take their places.
  bool lenient = false;
  // Of a file that may hold several cameras: the name or the number of one; default: the first.
  std::optional<std::string> camera{};
  // Of a file that may hold several animations: the name or the number of one; default: the first.
  std::optional<std::string> animation{};
  // Which part of the animation is needed; default: its beginning, as a still picture.
  std::function<AnimationWindow(const AnimationTime&)> window{};
  // In place of the scene's own.
  std::optional<Environment> environment{};
};

// What a lenient reading left out of a scene, or took otherwise than it is stated.
struct Omission {
  std::string what;  // as the warning says that stands for it among the diagnostics
  SourceLocation first;
  int count = 1;  // of the same
};

// An animation and its length, in the file's unit of time.
struct NamedAnimation {
  std::string name;
  double seconds = 0;
};

// A scene, or no scene where an error was found. Diagnostics may hold warnings and notes beside a scene.
struct ReadResult {
  std::optional<SceneDesc> scene;
  Diagnostics diagnostics;
  std::vector<Omission> omissions{};  // in the order of their first places
  // Of a file that may hold several, whether they are rendered or not; a name may be empty.
  std::vector<std::string> cameras{};
  std::vector<NamedAnimation> animations{};
};

}  // namespace montelux
