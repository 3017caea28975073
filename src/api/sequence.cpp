// Images of a sequence.
#include <utility>

#include "api/automatic.h"
#include "render/motion.h"

namespace montelux {

struct PictureSequence::State {
  const LoadedScene::Parts& parts;
  RenderPlan plan;
  SeriesMemories memories;
};

PictureSequence::PictureSequence(std::unique_ptr<State> state) : state_(std::move(state)) {}
PictureSequence::~PictureSequence() = default;
PictureSequence::PictureSequence(PictureSequence&&) noexcept = default;

Result<PictureSequence> PictureSequence::prepare(const LoadedScene& scene, const RenderOptions& options) {
  Result<RenderPlan> plan = plan_render(scene.parts(), options);
  if (!plan) return plan.failure();
  return PictureSequence(std::make_unique<State>(State{scene.parts(), *std::move(plan), {}}));
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
  Rendering rendering = render_picture(parts, state_->plan, std::move(settings), observer);
  for (const auto& memory : state_->memories)
    if (memory) rendering.history_bytes += memory->bytes();
  if (state_->plan.motion) rendering.motion = motion_vectors(parts.scene, *parts.accel, motion);
  return rendering;
}

}  // namespace montelux
