// The verbs. Each adds itself to the parser: its options, its help, and its action.
#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace montelux::cli {

// The action of the selected verb once all options are read; returns the exit status.
using Action = std::function<int()>;

void add_render(CLI::App& app, Action& chosen);
void add_integrate(CLI::App& app, Action& chosen);
void add_merge(CLI::App& app, Action& chosen);
void add_info(CLI::App& app, Action& chosen);
void add_trace(CLI::App& app, Action& chosen);
void add_diff(CLI::App& app, Action& chosen);
void add_compare(CLI::App& app, Action& chosen);
void add_denoise(CLI::App& app, Action& chosen);
void add_tonemap(CLI::App& app, Action& chosen);
void add_list(CLI::App& app, Action& chosen);
void add_lab(CLI::App& app, Action& chosen);
void add_completion(CLI::App& app, Action& chosen);

}  // namespace montelux::cli
