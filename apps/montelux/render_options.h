// The options of montelux render, and what they state.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/render.h"
#include "options.h"

namespace montelux::cli {

struct RenderArguments {
  std::string scene;
  std::vector<std::string> files;
  LoadOptions load;
  RenderOptions render;
  DisplayRequest display;
  // The display of the first image of a sequence, used for all.
  std::shared_ptr<std::optional<ChosenDisplay>> shown = std::make_shared<std::optional<ChosenDisplay>>();
  bool json = false, quiet = false, no_progress = false, half = false;
  std::optional<std::string> checkpoint, resume;
  std::optional<double> every;  // seconds between checkpoints
  std::optional<ErrorTarget> target;
  std::optional<double> confidence;
  bool unbiased = false;
  std::optional<FrameRange> frames;
  std::optional<double> fps;
  std::optional<int> frame;  // the current one
  // Whether an image took longer than its budget.
  bool is_late(const Rendering& rendering) const { return render.budget && rendering.result.seconds > *render.budget; }
};

// Which passes a render has; and their number of samples.
void add_pass_options(CLI::App& verb, RenderOptions& render);

// For which pixels samples count.
void add_filter_samples_option(CLI::App& verb, RenderOptions& render);

// `arguments` must outlive the verb.
void add_render_options(CLI::App& verb, RenderArguments& arguments);

}  // namespace montelux::cli
