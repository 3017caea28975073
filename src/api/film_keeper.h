// Saved films, as the facade's render uses them. Inside the facade only.
#pragma once
#include "api/saved_film.h"

namespace montelux {

// Writes a film that is being rendered; `film` says what it is of.
Status save_snapshot(const std::filesystem::path& file, const SavedFilm& film, const FilmSnapshot& snapshot);

// Whether a render, which `now` describes without its film, may add to a saved film.
Status check_continues(const SavedFilm& film, const SavedFilm& now);

// The picture of a film, with its errors and its header. `judge`: of the requested error, if there is one.
Rendering rendering_of(PictureFacts facts, RenderResult result, const PassPlan& plan,
                       const std::optional<TargetJudge>& judge);

// Adds the intervals of the pixels. Returns false where they are unknown.
bool add_intervals(Rendering& rendering);

// What a picture is called of which only one pixel in each square of pixels is sampled.
std::string sparse_text(int stride);

}  // namespace montelux
