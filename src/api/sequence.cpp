// Images of a sequence.
#include <algorithm>
#include <utility>

#include "api/automatic.h"
#include "render/motion.h"

namespace montelux {

struct PictureSequence::State {
  const LoadedScene::Parts& parts;
  RenderPlan plan;
  SeriesMemories memories;
  SequenceDenoiser denoiser;
};

PictureSequence::PictureSequence(std::unique_ptr<State> state) : state_(std::move(state)) {}
PictureSequence::~PictureSequence() = default;
PictureSequence::PictureSequence(PictureSequence&&) noexcept = default;

Result<PictureSequence> PictureSequence::prepare(const LoadedScene& scene, const RenderOptions& options) {
  Result<RenderPlan> plan = plan_render(scene.parts(), options);
  if (!plan) return plan.failure();
  plan->is_sequence = true;
  return PictureSequence(std::make_unique<State>(State{scene.parts(), *std::move(plan), {}, {}}));
}

Rendering PictureSequence::render(const SequencePicture& picture, RenderObserver& observer) {
  const LoadedScene::Parts& parts = state_->parts;
  // By the first image, for all: the options have been checked.
  (void)choose_automatically(parts, state_->plan, observer);
  RenderSettings settings = state_->plan.settings;
  settings.image.seed = picture.seed, settings.image.shutter = shutter_for(picture.shutter, parts.picture);
  settings.sequence.memories = &state_->memories;
  if (picture.is_last) settings.sequence.max_memory = 0;
  const MotionRequest motion{settings.image.bounds, *settings.image.shutter, shutter_for(picture.before, parts.picture),
                             settings.threads};
  const auto remembers = [&] {
    return std::ranges::any_of(state_->memories, [](const auto& m) { return m != nullptr; });
  };
  const bool continues = remembers();
  Rendering rendering = render_picture(parts, state_->plan, std::move(settings), observer);
  for (const auto& memory : state_->memories)
    if (memory) rendering.history_bytes += memory->bytes();
  if (state_->plan.motion || state_->plan.denoises_sequence())
    rendering.motion = motion_vectors(parts.scene, *parts.accel, motion);
  if (state_->plan.denoises_sequence()) {
    // Images that continue from the samples of those before are not independent of them.
    if (continues || remembers()) state_->denoiser.forget();
    const auto denoise = [&](const Film& film) {
      return state_->denoiser.denoise(film, *rendering.motion, denoise_options(rendering.layers, motion.threads, {}));
    };
    add_denoised(rendering, denoise, observer);
  }
  if (!state_->plan.motion) rendering.motion.reset();
  return rendering;
}

}  // namespace montelux
