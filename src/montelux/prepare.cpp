#include <exception>
#include <new>

#include "api/description.h"
#include "montelux/describe.h"
#include "montelux/picture.h"

namespace montelux::api {

namespace {

constexpr const char* no_memory = "there is not enough memory";

// Calls what returns a result; what it throws becomes an error, too.
template <class Work>
auto guarded(Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return Error(no_memory);
  } catch (const std::exception& error) {
    return Error(error.what());
  } catch (...) {
    return Error("an exception of an unknown type was thrown");
  }
}

Message message_of(const Diagnostic& diagnostic) {
  const SourceLocation& at = diagnostic.where;
  std::string where = at.file ? *at.file : std::string();
  if (at.file && at.line > 0) where += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
  return {Severity(diagnostic.severity), std::move(where), diagnostic.message, diagnostic.hint};
}

Result<PreparedScene> result_of(LoadResult loaded) {
  std::vector<Message> messages;
  for (const Diagnostic& diagnostic : loaded.diagnostics.all()) messages.push_back(message_of(diagnostic));
  if (!loaded.scene) return Error("the scene cannot be rendered", std::move(messages));
  return PreparedScene(
      std::make_unique<PreparedScene::Parts>(PreparedScene::Parts{*std::move(loaded.scene), std::move(messages)}));
}

// Hands progress to a function of the caller's, and keeps what that throws until the render has ended.
class Observer final : public RenderObserver {
 public:
  explicit Observer(const std::function<bool(const api::Progress&)>& report) : report_(report) {}

  void progress(const montelux::Progress& now) override {
    if (!report_ || thrown_) return;
    try {
      stop_ |= !report_({now.fraction, now.elapsed, now.remaining, now.samples});
    } catch (...) {
      thrown_ = std::current_exception(), stop_ = true;
    }
  }
  bool stop_requested() override { return stop_; }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  const std::function<bool(const api::Progress&)>& report_;
  bool stop_ = false;
  std::exception_ptr thrown_;
};

}  // namespace

PreparedScene::PreparedScene(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;
PreparedScene::~PreparedScene() = default;

int PreparedScene::width() const { return parts_->scene.info().width; }
int PreparedScene::height() const { return parts_->scene.info().height; }
const std::vector<Message>& PreparedScene::messages() const { return parts_->messages; }

Result<Picture> PreparedScene::render(const RenderSettings& settings) const {
  return guarded([&]() -> Result<Picture> {
    RenderOptions options;
    options.samples = settings.samples, options.seconds = settings.seconds, options.seed = settings.seed;
    options.threads = settings.threads;
    options.integrator = settings.integrator, options.sampler = settings.sampler;
    if (settings.samples && settings.seconds)
      return Error("a render takes either a number of samples or a time, not both");
    Observer observer(settings.progress);
    montelux::Result<Rendering> rendering = render_scene(parts_->scene, options, observer);
    observer.rethrow();
    if (!rendering) return Error(rendering.error());
    return Picture(std::make_unique<Picture::Parts>(Picture::Parts{*std::move(rendering)}));
  });
}

Result<PreparedScene> prepare(const Scene& scene, const PrepareOptions& options) {
  return guarded([&] {
    LoadOptions load;
    load.threads = options.threads;
    return result_of(load_description(describe(scene.content()), load, 0));
  });
}

Result<PreparedScene> load(const std::filesystem::path& file, const PrepareOptions& options) {
  return guarded([&] {
    LoadOptions load;
    load.threads = options.threads;
    return result_of(load_scene(file, load));
  });
}

}  // namespace montelux::api
