#include "format/simulation_section.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "format/doubtful_number.h"
#include "format/output_columns.h"
#include "format/parameter_check.h"

namespace freeplay {
namespace {

// Below, rounding decides; above, the error says nothing.
constexpr Range tolerances{.minimum = 1e-14, .maximum = 0.1};
constexpr Range contact_steps{.minimum = 2.0, .maximum = 1e6};
constexpr long most_rows_in_contact = 1000;
constexpr double steps_of_accurate_contact = 5.0;  // at least; the error asks for more where they are needed

/// Reads the section into the draft's settings.
class SimulationSection {
 public:
  explicit SimulationSection(Draft& draft) : draft_(draft), settings_(draft.model.settings) {}

  void read(const CheckedValue& section) {
    MapReader map(section, "simulation");
    read_span(map);
    read_step(map);
    integrator_ = map.find("integrator");
    const auto output = map.find("output");
    const auto stop = map.find("stop");
    read_accuracy(map);
    settings_.interval = (settings_.end - settings_.start) / 1000.0;
    if (output) read_output(*output);
    if (stop) read_stop(*stop);
    map.finish();
  }

  /// What the command line says, and what neither it nor the file says.
  void complete(bool section_given) {
    const BuildOptions& options = draft_.options;
    if (options.end && !(*options.end > settings_.start)) {
      throw Error(Error::Category::usage, "usage",
                  fmt::format("--end {} must be greater than the start, {} s", *options.end, settings_.start));
    }
    if (options.step && !(*options.step > 0.0)) {
      throw Error(Error::Category::usage, "usage", fmt::format("--step {} must be > 0", *options.step));
    }
    if (options.step) settings_.accuracy = 0.0;
    if (options.accuracy) settings_.accuracy = *options.accuracy;
    if (options.accuracy || options.step) settings_.accuracy_location = {};
    if (options.format) take_format(*options.format);
    if (!section_given) {
      settings_.end = options.end.value_or(settings_.end);
      settings_.interval = (settings_.end - settings_.start) / 1000.0;
    }
    settings_.interval = options.interval.value_or(settings_.interval);
    check_interval();
    if (!options.channels.empty()) settings_.channels = options.channels;
    if (columns_ || !stop_values_.empty()) read_columns();
    create_integrator();
    complete_steps();
    doubt_discard();
  }

  bool frames_good() const { return frames_good_; }

 private:
  /// Of columns that are in error nothing more is said.
  void read_columns() {
    const int errors = draft_.diagnostics.errors();
    if (errors == 0) read_output_columns(columns_, stop_values_, draft_.model);
    if (errors > 0 || draft_.diagnostics.errors() > errors) draft_.unsure_columns.emplace_back("output.");
  }

  void read_span(MapReader& map) {
    const auto start = map.find("start");
    const auto end = map.find("end");
    if (start) settings_.start = start->quantity(dimension::time).value_or(0.0);
    const std::optional<double> written = end ? end->quantity(dimension::time) : std::optional<double>(settings_.end);
    const bool good = !written || *written > settings_.start;
    if (!good && (end || !draft_.options.end)) {
      (end ? *end : *start)
          .fail("out-of-range",
                fmt::format("'end' ({} s) must be greater than 'start' ({} s)", *written, settings_.start));
    }
    settings_.end = draft_.options.end.value_or(good && written ? *written : settings_.start + 1.0);
  }

  void read_step(MapReader& map) {
    step_ = map.find("step");
    if (!step_) return;
    if (!step_->node().is_map()) {
      settings_.step = step_->quantity(dimension::time, positive).value_or(settings_.step);
      return;
    }
    MapReader inner(*step_, "step");
    const auto size = inner.find("size");
    const auto adaptive = inner.find("adaptive");
    tolerance_ = inner.find("tolerance");
    smallest_ = inner.find("min");
    largest_ = inner.find("max");
    const auto per_contact = inner.find("per_contact");
    if (size) settings_.step = size->quantity(dimension::time, positive).value_or(settings_.step);
    if (adaptive) settings_.adaptive = adaptive->boolean().value_or(false);
    if (tolerance_) {
      settings_.tolerance = tolerance_->quantity(dimension::none, tolerances).value_or(settings_.tolerance);
    }
    if (smallest_) settings_.smallest_step = smallest_->quantity(dimension::time, positive).value_or(0.0);
    if (largest_) settings_.largest_step = largest_->quantity(dimension::time, positive).value_or(unbounded);
    if (per_contact) {
      settings_.per_contact = per_contact->quantity(dimension::none, contact_steps).value_or(settings_.per_contact);
    }
    inner.finish();
  }

  void read_accuracy(MapReader& map) {
    accuracy_ = map.find("accuracy");
    if (draft_.options.step_by_map) accuracy_.reset();
    if (!accuracy_ || map.conflict("step", "accuracy")) return;
    settings_.accuracy = accuracy_->quantity(dimension::length, positive).value_or(0.0);
    settings_.accuracy_location = accuracy_->location();
  }

  /// What the file leaves open. An accuracy leaves everything open: the first step and the bounds are wide enough that
  /// the error decides.
  void complete_steps() {
    const double span = settings_.end - settings_.start;
    if (settings_.accuracy > 0.0) {
      settings_.adaptive = true;
      settings_.step = 1e-5 * span;
      settings_.smallest_step = 1e-14 * span;
      settings_.largest_step = std::min(0.25 * span, draft_.options.largest_step.value_or(unbounded));
      settings_.per_contact = steps_of_accurate_contact;
    } else {
      if (draft_.options.step) settings_.step = *draft_.options.step;
      if (!smallest_) settings_.smallest_step = 1e-3 * settings_.step;
      if (!largest_) settings_.largest_step = 10.0 * settings_.step;
    }
    const auto in_order = [&](const std::optional<CheckedValue>& value, bool good, const std::string& rule) {
      if (value && !good && !draft_.options.step && settings_.accuracy == 0.0) value->fail("out-of-range", rule);
    };
    in_order(smallest_, settings_.smallest_step <= settings_.step,
             fmt::format("'min' must not be above 'size', {} s", settings_.step));
    in_order(largest_, settings_.largest_step >= settings_.step,
             fmt::format("'max' must not be below 'size', {} s", settings_.step));
    require_estimate();
    doubt_written_step(span);
    warn_of_idle_keys();
  }

  void doubt_written_step(double span) const {
    if (!step_ || draft_.options.step || settings_.accuracy > 0.0) return;
    const Node* size = step_->node().is_map() ? step_->node().find("size") : &step_->node();
    if (size == nullptr || !size->is_scalar()) return;
    doubt_step(CheckedValue(step_->reading(), *size, nullptr, "simulation.step"), settings_.step, span);
  }

  /// What only an adaptive run looks at.
  void warn_of_idle_keys() const {
    if (settings_.adaptive || draft_.options.step || draft_.diagnostics.has_errors()) return;
    for (const auto& [key, value] : {std::pair{"tolerance", &tolerance_}, {"min", &smallest_}, {"max", &largest_}}) {
      if (!*value) continue;
      (*value)->warn_at_key("unused",
                            fmt::format("'{}' has no effect on fixed steps: 'adaptive: true' is missing", key));
    }
  }

  /// An integrator without an error estimate cannot choose its steps.
  void require_estimate() {
    if (!settings_.integrator) return;
    IntegratorLayout layout;
    Message message;
    if (!settings_.integrator.declare(layout, message)) return;  // reported when the run begins
    if (layout.always_adaptive != 0) settings_.adaptive = true;
    if (!settings_.adaptive || layout.error_estimate != 0) return;
    const std::string why = fmt::format("integrator '{}' gives no error estimate: it takes fixed steps only",
                                        settings_.integrator_parameters.component->description.name);
    if (accuracy_ && settings_.accuracy > 0.0 && !draft_.options.accuracy) return accuracy_->fail("out-of-range", why);
    if (step_ && settings_.accuracy == 0.0) return step_->fail("out-of-range", why);
    throw Error(Error::Category::usage, "usage", why);
  }

  void read_output(const CheckedValue& value) {
    MapReader map(value, "output");
    interval_ = map.find("interval");
    const auto channels = map.find("channels");
    columns_ = map.find("columns");
    const auto frames = map.find("frames");
    const auto format = map.find("format");
    const auto rows_in_contact = map.find("rows_in_contact");
    discard_ = map.find("discard");
    if (interval_) settings_.interval = interval_->quantity(dimension::time, positive).value_or(settings_.interval);
    const double span = settings_.end - settings_.start;
    if (interval_ && !draft_.options.interval) doubt_interval(*interval_, settings_.interval, span);
    if (channels) read_channels(*channels);
    if (frames) read_frames(*frames);
    if (format) read_format(*format);
    if (rows_in_contact) {
      settings_.rows_in_contact = static_cast<int>(rows_in_contact->integer(0, most_rows_in_contact).value_or(0));
    }
    if (discard_) settings_.discard = discard_->quantity(dimension::time, not_negative).value_or(0.0);
    map.finish();
  }

  /// Rows have times of their own: doubles tell them apart.
  void check_interval() const {
    const double farthest = std::max(std::abs(settings_.start), std::abs(settings_.end));
    const double least = 2.0 * (std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest);
    if (settings_.interval >= least) return;
    const std::string words =
        fmt::format("{:g} s between rows is less than times of {:g} s can differ by; it must be at least {:.2g} s",
                    settings_.interval, farthest, least);
    if (interval_ && !draft_.options.interval) return interval_->fail("out-of-range", words);
    throw Error(Error::Category::usage, "usage", "--interval: " + words);
  }

  /// A run whose end leaves nothing to tables.
  void doubt_discard() const {
    const double from = settings_.start + settings_.discard;
    if (!discard_ || from < settings_.end) return;
    discard_->warn("no-statistics",
                   fmt::format("statistics begin at {:g} s, but the run ends at {:g} s: its table and summary will "
                               "have none; make 'discard' smaller than the run is long",
                               from, settings_.end));
  }

  void read_channels(const CheckedValue& value) {
    settings_.channels.clear();
    const auto items = value.list();
    if (!items) return;
    for (const CheckedValue& item : *items) {
      if (const auto pattern = item.string()) settings_.channels.push_back(*pattern);
    }
  }

  void read_frames(const CheckedValue& value) {
    const auto items = value.list();
    frames_good_ = items.has_value();
    if (!items) return;
    for (const CheckedValue& item : *items) {
      const auto marker = draft_.marker(item, draft_.parts.front());
      if (marker) settings_.frames.push_back(*marker);
      frames_good_ = frames_good_ && marker.has_value();
    }
  }

  void read_format(const CheckedValue& value) {
    if (const auto word = value.word({std::begin(result_formats), std::end(result_formats)}))
      take_format(static_cast<ResultFormat>(*word));
  }

  void take_format(ResultFormat format) {
    settings_.format = format;
    settings_.format_given = true;
  }

  void read_stop(const CheckedValue& value) {
    if (is_condition_in_words(value)) return;
    const auto items = value.list();
    if (!items) return;
    for (const CheckedValue& item : *items) {
      if (!is_condition_in_words(item)) read_condition(item);
    }
  }

  /// What is plain elsewhere, as "t above 7 ms", says here how a condition is written. True after a message.
  static bool is_condition_in_words(const CheckedValue& value) {
    const Node& node = value.node();
    if (!node.is_scalar() || node.text.find(' ') == std::string::npos) return false;
    value.fail("wrong-type", "'" + value.path() + "' is a condition in words", {},
               "write a list of maps, as [{channel: time, above: 7 ms}]; where only a time is meant, 'end'");
    return true;
  }

  void read_condition(const CheckedValue& value) {
    MapReader map(value, "stop");
    const auto channel = map.find("channel"), formula = map.find("value");
    map.conflict("channel", "value");
    if (map.good() && !channel && !formula) map.report_missing("channel");
    const auto above = map.find("above");
    const auto below = map.find("below");
    const auto after = map.find("after");
    map.conflict("above", "below");
    if (map.good() && !above && !below) map.report_missing("above");
    StopCondition stop;
    stop.location = channel ? channel->location() : value.location();
    stop.above = above.has_value();
    if (channel) stop.channel = channel->string().value_or("");
    if (formula) {
      stop.location = formula->location();
      stop.channel = fmt::format("output.stop{}", settings_.stop.size() + 1);
      stop_values_.emplace_back(stop.channel, *formula);
    }
    const auto& limit = above ? above : below;
    // Its dimension is that of the channel, which is unknown until the model is complete.
    if (limit) {
      stop.quantity = limit->any_quantity().value_or(Quantity{});
      stop.limit = stop.quantity.value;
      stop.quantity_location = limit->location();
    }
    if (after) stop.after = after->quantity(dimension::time).value_or(0.0);
    map.finish();
    if (!stop.channel.empty()) settings_.stop.push_back(std::move(stop));
  }

  // --- integrator ------------------------------------------------------------------------------------------------

  void create_integrator() {
    const Component* chosen = nullptr;
    if (integrator_) chosen = read_integrator(*integrator_);
    const bool own = integrator_ && draft_.options.integrator_by_map;
    const bool by_accuracy = !own && (draft_.options.accuracy || (!integrator_ && settings_.accuracy > 0.0));
    if (by_accuracy && !draft_.options.integrator) {
      const Component* best = draft_.registry.preferred(ComponentKind::integrator, 2);
      if (best != nullptr) return use_defaults(*best);
    }
    if (draft_.options.integrator) {
      const Component* asked = asked_for(*draft_.options.integrator);
      if (asked != chosen) use_defaults(*asked);
    } else if (!integrator_) {
      const Component* preferred = draft_.registry.preferred(ComponentKind::integrator);
      if (preferred != nullptr) use_defaults(*preferred);
    }
  }

  /// The file's choice, checked and created even if the command line asks for another.
  const Component* read_integrator(const CheckedValue& value) {
    const bool by_name = value.node().is_scalar();
    if (!by_name && !value.node().is_map()) {
      value.wrong_type("a name or a map");
      return nullptr;
    }
    MapReader map = by_name ? MapReader::empty(value) : MapReader(value);
    const auto type = by_name ? std::optional<CheckedValue>(value) : map.require("type");
    const Component* component = type ? find_type(draft_.registry, ComponentKind::integrator, *type) : nullptr;
    if (component == nullptr) return nullptr;
    create(check_parameters(*component, map, draft_), value);
    map.finish();
    return component;
  }

  const Component* asked_for(const std::string& name) const {
    const Component* found = draft_.registry.find(ComponentKind::integrator, name);
    if (found != nullptr) return found;
    if (const char* remedy = draft_.registry.remedy(ComponentKind::integrator, name)) {
      throw Error(Error::Category::usage, "usage", "--integrator " + name + ": it is not in this build", {}, remedy);
    }
    const std::vector<std::string> names = draft_.registry.names(ComponentKind::integrator);
    const std::string suggested = nearest(name, names);
    throw Error(Error::Category::usage, "usage", "--integrator " + name + ": there is no such integrator", {},
                suggested.empty() ? "there is " + either(names) : "did you mean '" + suggested + "'?");
  }

  void use_defaults(const Component& component) {
    const Node nothing;
    const CheckedValue owner(*draft_.top, nothing, nullptr, "simulation.integrator");
    MapReader map = MapReader::absent(owner);
    create(check_parameters(component, map, draft_), owner);
  }

  void create(CheckedParameters checked, const CheckedValue& place) {
    if (!checked.block) return;
    CreationFault fault;
    settings_.integrator = draft_.model.instances.create_integrator(*checked.block, fault);
    if (!settings_.integrator) return report_fault(fault, checked, place);
    settings_.integrator_parameters = std::move(*checked.block);
  }

  Draft& draft_;
  Settings& settings_;
  bool frames_good_ = true;
  std::vector<std::pair<std::string, CheckedValue>> stop_values_;  ///< and the columns that they become
  std::optional<CheckedValue> integrator_, step_, accuracy_, tolerance_, smallest_, largest_, discard_, interval_,
      columns_;
};

}  // namespace

double read_start_time(const CheckedValue& section) {
  if (!section.node().is_map()) return 0.0;  // reported by read_simulation()
  const auto start = MapReader(section, "simulation").find("start");
  return start ? start->quantity(dimension::time).value_or(0.0) : 0.0;
}

bool read_simulation(Draft& draft, const std::optional<CheckedValue>& section) {
  SimulationSection reader(draft);
  if (section) reader.read(*section);
  reader.complete(section.has_value());
  return reader.frames_good();
}

}  // namespace freeplay
