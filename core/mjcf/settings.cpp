#include "mjcf/settings.h"

#include <algorithm>

#include <fmt/format.h>

namespace freeplay::mjcf {
namespace {

const std::vector<std::string> no_or_yes{"false", "true"};

void read_compiler(XmlElement& xml, Settings& settings, Messages& messages) {
  Element compiler(xml, "the compiler", messages, false);
  if (compiler.find("angle") != nullptr) {
    const bool degrees = choice(compiler, "angle", {"radian", "degree"}, 1, messages) == 1;
    settings.angle_unit = degrees ? std::numbers::pi / 180.0 : 1.0;
  }
  if (const XmlAttribute* axes = compiler.find("eulerseq")) {
    const std::string_view word = axes->Value();
    if (word.size() == 3 && word.find_first_not_of("xyzXYZ") == std::string_view::npos) {
      settings.euler_axes = word;
    } else {
      messages.error(spot_of(xml, *axes), "bad-urdf",
                     fmt::format("'eulerseq' must be three of xyzXYZ, not '{}'", word));
    }
  }
  if (choice(compiler, "coordinate", {"local", "global"}, 0, messages) == 1) {
    messages.error(spot_of(xml, "coordinate"), "bad-urdf", "global coordinates are not read", {},
                   "MuJoCo dropped them; save the model with a version that writes local ones");
  }
  const std::size_t automatic = choice(compiler, "autolimits", no_or_yes, settings.auto_limits ? 1 : 0, messages);
  settings.auto_limits = automatic == 1;
  settings.inertia_from_geoms =
      static_cast<Settings::Inertia>(choice(compiler, "inertiafromgeom", {"false", "true", "auto"},
                                            static_cast<std::size_t>(settings.inertia_from_geoms), messages));
  const std::vector<double> groups = compiler.numbers("inertiagrouprange", 2);
  if (!groups.empty()) {
    settings.lowest_group = static_cast<int>(std::clamp(groups[0], -1e6, 1e6));
    settings.highest_group = static_cast<int>(std::clamp(groups[1], -1e6, 1e6));
  }
  settings.least_mass = compiler.number("boundmass", settings.least_mass);
  settings.least_moment = compiler.number("boundinertia", settings.least_moment);
  settings.total_mass = compiler.number("settotalmass", settings.total_mass);
  // What changes no motion: where other files lie, and how MuJoCo keeps the model.
  for (const char* name : {"meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "usethread", "fusestatic",
                           "exactmeshinertia", "saveinertial", "alignfree", "fitaabb", "convexhull"}) {
    compiler.find(name);
  }
  compiler.finish();
}

void read_flags(XmlElement& xml, Settings& settings, Messages& messages) {
  Element flag(xml, "the flag", messages, false);
  const std::vector<std::string> words{"disable", "enable"};
  if (choice(flag, "gravity", words, 1, messages) == 0) settings.gravity.setZero();
  if (choice(flag, "equality", words, settings.has_equalities ? 1 : 0, messages) == 0) settings.has_equalities = false;
  flag.finish();
}

void read_option(XmlElement& xml, Settings& settings, Messages& messages) {
  Element option(xml, "the option", messages, false);
  if (const auto gravity = option.vector("gravity")) {
    settings.gravity = *gravity;
    settings.gravity_spot = spot_of(xml, "gravity");
  }
  if (XmlElement* flags = option.child("flag")) read_flags(*flags, settings, messages);
  option.finish();
}

}  // namespace

std::size_t choice(Element& element, const std::string& name, const std::vector<std::string>& words,
                   std::size_t standard, Messages& messages) {
  const XmlAttribute* attribute = element.find(name);
  if (attribute == nullptr) return standard;
  const auto found = std::ranges::find(words, attribute->Value());
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  messages.error(spot_of(element.xml(), *attribute), "bad-urdf",
                 fmt::format("unknown word '{}' as '{}' of {}", attribute->Value(), name, element.owner()),
                 messages.suggest(attribute->Value(), words), fmt::format("one of {}", fmt::join(words, ", ")));
  return standard;
}

Settings read_settings(XmlElement& root, Messages& messages) {
  Settings settings;
  settings.gravity_spot = name_spot(root);
  for (XmlElement& child : XmlChildren(root)) {
    if (urdf::is(child, "compiler")) read_compiler(child, settings, messages);
  }
  for (XmlElement& child : XmlChildren(root)) {
    if (urdf::is(child, "option")) read_option(child, settings, messages);
  }
  return settings;
}

}  // namespace freeplay::mjcf
