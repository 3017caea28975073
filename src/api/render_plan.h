// A render as planned by the options and the scene. Internal to the facade.
#pragma once
#include "api/parts.h"
#include "api/render.h"
#include "api/saved_film.h"
#include "integrator/catalogue.h"

namespace montelux {

// A choice that is to be made once the length of the render is known.
struct AutomaticPlan {
  ChoiceText choice;  // "auto" with its settings
  RenderOptions options;
};

// Everything that determines a render, checked.
struct RenderPlan {
  RenderSettings settings;  // without stopping rule
  ChosenIntegrator chosen;
  std::unique_ptr<PixelIntegrator> unbiased;  // the same without limits, if the bias is to be measured
  std::vector<Replacement> replaced;
  FilesToWrite files;
  std::string integrator_text;             // the integrator, with its settings in a canonical order
  std::optional<AutomaticPlan> automatic;  // until the choice is made
  std::optional<AutomaticChoice> choice;   // then
  std::optional<double> seconds;           // the time, including preparation and writing; or
  std::optional<double> budget;            // the time of each image, without writing
  std::optional<TargetRequest> target;     // the error that ends it, with at most these samples per pixel
  int max_samples = max_film_samples;
  bool adaptive = false;
  std::optional<int> samples_per_pass;  // as requested
  bool motion = false;                  // of a sequence: with motion vectors
  bool denoise = false;
  std::shared_ptr<const ColorFilter> filter;  // that removes the noise; null: ours
  std::shared_ptr<JudgedLayers> judged;       // what the judge of a target has filtered last
  bool is_sequence = false;
  bool intervals = false;  // of the pixels
  double preparation = 0;  // seconds that the making of the integrator took (pilots, meshes of elements), until an
                           // image has counted them
  double ending = 0;       // seconds from the last frame of the image before to its end

  // The images before help to remove the noise, which is left to the sequence. Filters that are not ours take each
  // image alone.
  bool denoises_sequence() const { return denoise && is_sequence && !filter; }
};

// "direct:candidates=4,strategy=ris", in whatever order the settings were given.
std::string canonical_text(const ChoiceText& choice);

// The passes of the plan's integrator. `default_samples`: if the options state none.
Status plan_samples(const RenderOptions& options, int default_samples, RenderPlan& plan);

Result<RenderPlan> plan_render(const LoadedScene::Parts& parts, const RenderOptions& options);

Shutter shutter_for(const ShutterTimes& times, const PictureSettings& picture);

PictureFacts facts_of(const LoadedScene::Parts& parts, const RenderPlan& plan, const RenderSettings& settings);

// The description of a film that is rendered, without the film itself.
SavedFilm description_of(const LoadedScene::Parts& parts, const RenderPlan& plan, const RenderOptions& options);

// Renders one image: that of the plan, with settings whose seed, shutter, memories and film may differ. `film`, if
// there is one, receives the length of the passes and the time of the preparation before it is saved.
// Its noise is removed if the plan says so, unless the sequence does that.
Rendering render_picture(const LoadedScene::Parts& parts, RenderPlan& plan, RenderSettings settings,
                         RenderObserver& observer, SavedFilm* film = nullptr);

// Adds the layers without noise to an image that has light, or a note where that is not possible. `denoise` makes them
// of a film.
void add_denoised(Rendering& rendering, const std::function<Result<DenoisedLayers>(const Film&)>& denoise,
                  RenderObserver& observer);

}  // namespace montelux
