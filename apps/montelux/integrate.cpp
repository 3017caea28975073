// montelux integrate: a formula becomes a number with its error.
#include "api/integrate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

#include "api/catalogue.h"
#include "api/images.h"
#include "integral_output.h"
#include "options.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct IntegrateArguments {
  IntegralOptions integral;
  std::optional<std::uint64_t> seed;
  std::optional<double> confidence;
  int threads = 0;
  std::optional<std::string> save, resume;
  IntegralOutput output;
  bool no_progress = false;
};

constexpr const char* examples = R"(Examples:
  montelux integrate '4*x^3' --over x=0:1
  montelux integrate 'exp(-x*y)' --over x=0:1,y=0:2 --target-error 1e-4 --confidence 0.95
  montelux integrate 'z^2' --over sphere --method uniform --method qmc --method vegas
  montelux integrate 'exp(-x^2)' --over x=-inf:inf --method vegas --samples 1e6 --json
  montelux integrate '4*x^3' --over x=0:1 --pdf '2*x, inverse=sqrt(u)'
  montelux integrate 'sqrt(x)' --over x=0:1 --control x --control-integral 0.5
  montelux integrate 'sin(10*r)/r' --over disk:radius=2 --time 1h --save run.json
  montelux integrate --resume run.json --time 1h --save run.json

Expressions: + - * / ^ ( ) < <= > >= == != && || ! and condition ? a : b; montelux list functions.
Domains: intervals NAME=LOW:HIGH, with expressions as bounds (pi/2, inf, earlier variables), and montelux list domains;
--over may be repeated: the domain is the product. Methods: montelux list methods. An expression that begins with a minus
is written after "--". Ctrl-C ends early and prints the result so far.
)";

// "1000000", "1e6" or "4M".
Result<std::uint64_t> parse_samples(const std::string& text) {
  if (const auto samples = parse_large_whole(text, 2, 1'000'000'000'000'000)) return samples;
  return Failure{fmt::format("takes a whole number from 2, such as 100000, 1e6 or 4M; found \"{}\"", text)};
}

// "0.95" or "95%".
Result<double> parse_confidence(const std::string& text) {
  const bool percent = text.ends_with('%');
  const Result<double> value = parse_number(percent ? text.substr(0, text.size() - 1) : text, 0, 100);
  const double share = value ? (percent ? *value / 100 : *value) : 0;
  if (share > 0 && share < 1) return share;
  return Failure{fmt::format("takes a probability between 0 and 1, such as 0.95 or 95%; found \"{}\"", text)};
}

// The integral of a file, with the budget that is stated now, or else what is left of the file's.
Result<SavedIntegral> resumed(const IntegrateArguments& arguments) {
  const IntegralOptions& now = arguments.integral;
  const lab::IntegralStatement& s = now.statement;
  if (!s.integrand.empty() || !s.over.empty() || !s.densities.empty() || s.control || s.target ||
      !now.methods.empty() || arguments.seed)
    return Failure{"--resume takes the integral, its methods and its seed from the file; only the budget may be given"};
  Result<SavedIntegral> saved = load_integral(*arguments.resume);
  if (!saved) return saved;
  lab::Budget& budget = saved->options.budget;
  if (arguments.confidence) budget.confidence = *arguments.confidence;
  if (now.budget.samples || now.budget.seconds || now.budget.target_error) {
    const double confidence = budget.confidence;
    budget = now.budget, budget.confidence = confidence;
    return saved;
  }
  const auto rest = rest_of_budget(*saved);
  if (!rest)
    return Failure{fmt::format("{} has used up its budget; state how much more by --samples, --time or --target-error",
                               *arguments.resume)};
  budget = *rest;
  return saved;
}

std::string progress_text(const lab::IntegralProgress& p, const std::string& method, bool several) {
  const double speed = p.elapsed > 0 ? double(p.evaluations) / p.elapsed : 0;
  return fmt::format("{}{}  {}  {:.6g} ± {:.2g}{}{}", several ? method + "  " : "", time_text(p.elapsed),
                     count_text(speed, "evaluations/s"), p.mean, p.standard_error, p.note.empty() ? "" : "  ", p.note);
}

// The runs; after a signal there are fewer than methods.
Result<std::vector<IntegralRun>> run_watched(const IntegrateArguments& arguments, const PreparedIntegral& integral,
                                             const SavedIntegral* resume, const StopSignals& signals) {
  StatusLine line(!arguments.output.quiet && !arguments.no_progress);
  IntegralWatch watch;
  watch.threads = arguments.threads;
  watch.stop = [&signals] { return signals.received() != 0; };
  const auto& methods = integral.options.methods;
  watch.progress = [&](std::size_t k, const lab::IntegralProgress& p) {
    line.show((double(k) + p.fraction) / double(methods.size()), p.elapsed,
              [&] { return progress_text(p, methods[k], methods.size() > 1); });
  };
  auto runs = run_integral(integral, watch, resume);
  line.finish();
  return runs;
}

int run_integrate(IntegrateArguments& arguments) {
  if (arguments.save)
    if (Status good = check_integral_file(*arguments.save); !good) return complain(good.error());
  std::optional<SavedIntegral> saved;
  if (arguments.resume) {
    Result<SavedIntegral> loaded = resumed(arguments);
    if (!loaded) return complain(loaded.error());
    saved = std::move(*loaded);
  } else {
    if (arguments.integral.statement.integrand.empty())
      return complain("an expression is missing, for example montelux integrate '4*x^3' --over x=0:1");
    if (arguments.integral.statement.over.empty())
      return complain("a domain is missing: --over x=0:1, --over disk, ...");
    arguments.integral.seed = arguments.seed.value_or(0);
    arguments.integral.budget.confidence = arguments.confidence.value_or(default_confidence);
  }
  const IntegralPreparation prepared = prepare_integral(saved ? saved->options : arguments.integral);
  if (!prepared.integral) return complain_of_all(prepared.mistakes);
  if (!arguments.output.quiet)
    for (const std::string& note : prepared.notes) warn(note);

  StopSignals signals;
  const auto runs = run_watched(arguments, *prepared.integral, saved ? &*saved : nullptr, signals);
  if (!runs) return complain(runs.error());
  const bool interrupted = !runs->empty() && runs->back().result.stopped_because == lab::StopReason::stopped;
  if (interrupted && runs->size() == 1 && runs->front().result.passes == 0) {
    complain("interrupted before there was a result");
    return 128 + signals.received();
  }
  int status = interrupted ? 128 + signals.received() : done;
  if (arguments.save) {
    SavedIntegral now = saved_of(*prepared.integral, *runs);
    if (Status written = save_integral(*arguments.save, now); !written) {
      complain(written.error());
      status = failed;
    }
  }
  const int doubts = print_integrals(arguments.output, prepared.integral->options, *runs);
  if (status == done) status = doubts;
  if (interrupted && !arguments.output.quiet) warn("interrupted; this is the result so far");
  return status;
}

// What is integrated, and how.
void add_statement_options(CLI::App& verb, IntegralOptions& integral) {
  lab::IntegralStatement& s = integral.statement;
  verb.add_option("EXPR", s.integrand, "the integrand, for example '4*x^3'")->type_name("EXPR");
  add_option(verb, {"--over", "DOMAIN", "x=0:1,y=0:x, or disk, sphere, ...; repeated: their product", true},
             append_to(s.over));
  const std::vector<CatalogueEntry> known = catalogue("methods").value();
  std::vector<std::string> methods;
  for (const CatalogueEntry& entry : known) methods.push_back(entry.name);
  add_option(verb,
             {"--method", alternatives(methods),
              "with settings NAME:key=value,...; repeated: a table that compares them; default auto", true},
             append_to(integral.methods));
  add_option(verb,
             {"--pdf", "EXPR",
              "density to sample from: '2*x' or '2*x, inverse=sqrt(u)'; other settings: sampling=table|rejection, "
              "bound=MAXIMUM; may be repeated for mis",
              true},
             append_to(s.densities));
  verb.add_flag("--normalize-pdf", s.normalize_densities, "divide densities by their measured integrals");
  verb.add_flag("--allow-missed", s.allow_missed,
                "accept a density that is 0 where the integrand is not: biased, and reported as such");
  add_option(verb, {"--control", "EXPR", "control variate for the method control"}, text_into(s.control));
  add_option(verb, {"--control-integral", "VALUE", "its integral over the domain; an expression without variables"},
             text_into(s.control_integral));
  add_option(verb, {"--target", "EXPR", "density of ris and metropolis, not normalised; default |integrand|"},
             text_into(s.target));
}

// The budget, and the realisation.
void add_budget_options(CLI::App& verb, IntegrateArguments& arguments) {
  lab::Budget& budget = arguments.integral.budget;
  add_option(verb, {"--samples", "N", "samples of each method: 100000, 1e6 or 4M (default 1048576)"},
             into(budget.samples, parse_samples));
  add_option(verb, {"--time", "TIME", "for each method: 500ms, 30s, 10m or 2h"}, into(budget.seconds, parse_time));
  add_option(verb, {"--target-error", "ERROR", "stop when half the interval is this small: 1e-4, or 0.1% of the value"},
             [&budget](const std::string& text) -> Status {
               const bool percent = text.ends_with('%');
               const auto value = parse_number(percent ? text.substr(0, text.size() - 1) : text, 0, 1e300);
               if (!value || !(*value > 0))
                 return Failure{
                     fmt::format("takes a number above 0 or a percentage, such as 1e-4 or 0.1%; found \"{}\"", text)};
               budget.target_error = percent ? *value / 100 : *value, budget.target_is_relative = percent;
               return Done{};
             });
  add_option(verb, {"--confidence", "P", "of the interval: 0.99 or 99% (default 0.95)"},
             into(arguments.confidence, parse_confidence));
  add_option(verb, {"--seed", "S", "seed of all random numbers; the same seed gives the same bits (default 0)"},
             into(arguments.seed, [](const std::string& t) -> Result<std::uint64_t> {
               auto seed = parse_whole(t, 0, 0x7fffffff);
               if (!seed) return seed.failure();
               return std::uint64_t(*seed);
             }));
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(arguments.threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
}

}  // namespace

void add_integrate(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<IntegrateArguments>();
  CLI::App& verb = *app.add_subcommand("integrate", "Integrate a formula, with an error bar");
  verb.footer(examples);
  add_statement_options(verb, arguments->integral);
  add_budget_options(verb, *arguments);
  add_option(verb, {"--save", "FILE", "save the estimate, to be resumed or merged"}, text_into(arguments->save));
  add_option(verb, {"--resume", "FILE", "continue a saved estimate"}, text_into(arguments->resume));
  add_output_options(verb, arguments->output);
  verb.add_flag("--no-progress", arguments->no_progress, "no progress");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_integrate(*arguments); }; });
}

}  // namespace montelux::cli
