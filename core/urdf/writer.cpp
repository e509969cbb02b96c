#include "urdf/writer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "base/index.h"
#include "base/number_text.h"
#include "format/name_rule.h"
#include "urdf/kept_sections.h"
#include "urdf/xml_printer.h"

namespace freeplay {
namespace {

struct Place {
  double x = 0.0, y = 0.0, angle = 0.0;
};

Place compose(const Place& a, double x, double y, double angle) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {a.x + c * x - s * y, a.y + s * x + c * y, a.angle + angle};
}

bool same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(1.0, std::abs(a)); }

class UrdfWriter {
 public:
  UrdfWriter(const Document& document, const Model& model, const Readout& readout, std::span<const double> q,
             std::span<const double> v, const std::string& urdf_file)
      : document_(document),
        model_(model),
        readout_(readout),
        q_(q),
        v_(v),
        urdf_file_(urdf_file),
        target_(document.file_name(), "") {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      body_ids_.emplace(model.bodies[b].name, static_cast<BodyId>(b));
    }
  }

  UrdfText write() {
    choose_tree();
    source_ = &with_own_origins(document_.root());
    const std::string robot = robot_text();
    const bool needed = make_sidecar();
    return {robot, needed ? std::optional<Document>(std::move(target_)) : std::nullopt, std::move(notes_)};
  }

 private:
  const Marker& first(const JointElement& joint) const { return model_.markers[at(joint.marker_a)]; }
  const Marker& second(const JointElement& joint) const { return model_.markers[at(joint.marker_b)]; }

  // --- the tree --------------------------------------------------------------------------------------------------

  void choose_tree() {
    tree_joint_.assign(model_.bodies.size(), -1);
    in_tree_.assign(model_.joints.size(), false);
    std::vector<std::vector<int>> leaving(model_.bodies.size() + 1);
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const JointElement& joint = model_.joints[j];
      if (is_geometric(joint)) leaving[at(first(joint).body + 1)].push_back(static_cast<int>(j));
    }
    std::deque<BodyId> open = {ground};
    while (!open.empty()) {
      const BodyId body = open.front();
      open.pop_front();
      for (const int j : leaving[at(body + 1)]) {
        const JointElement& joint = model_.joints[at(j)];
        const BodyId child = second(joint).body;
        if (child == ground || tree_joint_[at(child)] >= 0 || !frames_agree(joint)) continue;
        tree_joint_[at(child)] = j;
        in_tree_[at(j)] = true;
        open.push_back(child);
      }
    }
  }

  static bool is_geometric(const JointElement& joint) {
    if (joint.gear >= 0 || joint.is_force || joint.ideal_component() == nullptr) return false;
    const std::string_view type = joint.ideal_component()->description.name;
    return type == "revolute" || type == "prismatic" || type == "fixed";
  }
  static bool slides(const JointElement& joint) {
    return std::string_view(joint.ideal_component()->description.name) == "prismatic";
  }

  /// A body's frame moves to the second frame of its joint of the tree.
  Place shift(BodyId body) const {
    if (body == ground || tree_joint_[at(body)] < 0) return {};
    const Marker& marker = second(model_.joints[at(tree_joint_[at(body)])]);
    return {marker.position[0], marker.position[1], 0.0};
  }

  /// The joint's frame on the parent link when it is read back: at coordinate zero the child's axes.
  Place origin(const JointElement& joint) const {
    const Marker& marker = first(joint);
    const Place moved = shift(marker.body);
    return {marker.position[0] - moved.x, marker.position[1] - moved.y, marker.angle - second(joint).angle};
  }

  const Marker* frame(BodyId body, const std::string& name) const {
    const std::string full = (body == ground ? "ground" : model_.bodies[at(body)].name) + "/" + name;
    const auto found = std::ranges::lower_bound(model_.frames, full, {}, &Marker::name);
    return found != model_.frames.end() && found->name == full ? &*found : nullptr;
  }

  /// Reading the URDF back makes frames with the joint's name. One that exists must be the same.
  bool frames_agree(const JointElement& joint) const {
    const Marker* on_first = frame(first(joint).body, joint.name);
    const Marker* on_second = frame(second(joint).body, joint.name);
    const auto agrees = [](const Marker* declared, const Marker& used, double angle) {
      return declared == nullptr || (declared->position == used.position && same(declared->angle, angle));
    };
    const double turn = second(joint).angle;
    return agrees(on_first, first(joint), slides(joint) ? first(joint).angle : first(joint).angle - turn) &&
           agrees(on_second, second(joint), slides(joint) ? turn : 0.0);
  }

  // --- origins -------------------------------------------------------------------------------------------------------

  /// A copy in which every reference to the origin of a body whose frame moves names a frame at the old place.
  const Node& with_own_origins(const Node& node) {
    Node& made = target_.add(node.kind, 1, 1);
    made.quoted = node.quoted;
    made.foreign = node.foreign;
    made.text = node.text;
    const std::vector<std::string>* names = node.is_scalar() ? readout_.find("", node) : nullptr;
    if (names != nullptr && names->size() == 1) made.text = own_origin(names->front()).value_or(node.text);
    for (const Node* item : node.items) made.items.push_back(&with_own_origins(*item));
    for (const Node::Entry& entry : node.entries) {
      made.entries.push_back({&with_own_origins(*entry.key), &with_own_origins(*entry.value)});
    }
    return made;
  }

  std::optional<std::string> own_origin(const std::string& reference) {
    constexpr std::string_view suffix = "/origin";
    if (!reference.ends_with(suffix)) return std::nullopt;
    const std::string body = reference.substr(0, reference.size() - suffix.size());
    const auto found = body_ids_.find(body);
    if (found == body_ids_.end()) return std::nullopt;
    const Place moved = shift(found->second);
    if (moved.x == 0.0 && moved.y == 0.0) return std::nullopt;
    std::string& name = origins_[found->second];
    for (name = "body-origin"; frame(found->second, name) != nullptr;) name += "_";
    return body + "/" + name;
  }

  Place start(BodyId id) const {
    const std::size_t b = at(id);
    const Body& body = model_.bodies[b];
    const Place moved = shift(id);
    return compose({q_[3 * b], q_[3 * b + 1], q_[3 * b + 2]}, moved.x - body.com[0], moved.y - body.com[1], 0.0);
  }

  // --- URDF ------------------------------------------------------------------------------------------------------

  static std::string n(double value) { return number_text(value + 0.0); }

  std::string robot_text() {
    XmlPrinter xml;
    xml.PushDeclaration("xml version=\"1.0\"");
    xml.open("robot", {{"name", robot_name()}});
    xml.element("link", {{"name", "ground"}});
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) print_link(xml, static_cast<BodyId>(b));
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      if (tree_joint_[b] < 0) {
        print_floating(xml, static_cast<BodyId>(b));
      } else {
        print_tree_joint(xml, static_cast<BodyId>(b));
      }
    }
    xml.CloseElement();
    return xml.CStr();
  }

  std::string robot_name() const {
    std::string name;
    for (const char c : model_.name) name += is_foreign_name(std::string("_") + c) ? c : '_';
    return name.empty() ? "robot" : name;
  }

  static std::string point_text(double x, double y) { return fmt::format("{} {} 0", n(x), n(y)); }

  /// Only the moment about the normal is known; as of a flat body, the others are half of it.
  void print_link(XmlPrinter& xml, BodyId id) const {
    const Body& body = model_.bodies[at(id)];
    const Place moved = shift(id);
    const std::string moment = n(body.inertia[8]), half = n(body.inertia[8] / 2);
    xml.open("link", {{"name", body.name}});
    xml.open("inertial", {});
    xml.element("origin", {{"xyz", point_text(body.com[0] - moved.x, body.com[1] - moved.y)}, {"rpy", "0 0 0"}});
    xml.element("mass", {{"value", n(body.mass)}});
    xml.element("inertia", {{"ixx", half}, {"ixy", "0"}, {"ixz", "0"}, {"iyy", half}, {"iyz", "0"}, {"izz", moment}});
    xml.CloseElement();
    xml.CloseElement();
  }

  void print_tree_joint(XmlPrinter& xml, BodyId child) const {
    const JointElement& joint = model_.joints[at(tree_joint_[at(child)])];
    const BodyId parent = first(joint).body;
    const double along = second(joint).angle;
    const std::string_view type = joint.ideal_component()->description.name;
    open_joint(xml, joint.name, type == "revolute" ? "continuous" : std::string(type),
               parent == ground ? "ground" : model_.bodies[at(parent)].name, child, origin(joint));
    if (type == "revolute") xml.element("axis", {{"xyz", "0 0 1"}});
    if (type == "prismatic") {
      xml.element("axis", {{"xyz", point_text(along == 0.0 ? 1.0 : std::cos(along), std::sin(along))}});
      xml.element("limit", {{"lower", "-1000"}, {"upper", "1000"}, {"effort", "1000"}, {"velocity", "1000"}});
    }
    xml.CloseElement();
  }

  void print_floating(XmlPrinter& xml, BodyId child) const {
    std::string name = model_.bodies[at(child)].name.substr(0, 50) + "-floating";
    const auto taken = [&](const JointElement& joint) { return joint.name == name; };
    while (std::ranges::any_of(model_.joints, taken)) name += "_";
    open_joint(xml, name, "floating", "ground", child, start(child));
    xml.CloseElement();
  }

  void open_joint(XmlPrinter& xml, const std::string& name, const std::string& type, const std::string& parent,
                  BodyId child, const Place& place) const {
    xml.open("joint", {{"name", name}, {"type", type}});
    xml.element("parent", {{"link", parent}});
    xml.element("child", {{"link", model_.bodies[at(child)].name}});
    xml.element("origin", {{"xyz", point_text(place.x, place.y)}, {"rpy", "0 0 " + n(place.angle)}});
  }

  // --- side-car --------------------------------------------------------------------------------------------------

  Node& scalar(const std::string& text) {
    Node& node = target_.add(Node::Kind::scalar, 1, 1);
    node.text = text;
    return node;
  }
  Node& map() { return target_.add(Node::Kind::map, 1, 1); }
  Node& point(double x, double y) {
    Node& node = target_.add(Node::Kind::list, 1, 1);
    node.items = {&scalar(n(x)), &scalar(n(y))};
    return node;
  }
  void put(Node& owner, const std::string& key, const Node& value) { owner.entries.push_back({&scalar(key), &value}); }

  /// Makes the root of the target; false when the URDF says everything.
  bool make_sidecar() {
    const Node& bodies = body_section();
    const Node& joints = joint_section();
    Node& root = map();
    put(root, "freeplay", scalar("1"));
    if (source_->find("name") != nullptr) put(root, "name", scalar(model_.name));
    std::vector<Node::Entry> rest;
    for (const Node::Entry& entry : source_->entries) {
      static const std::set<std::string, std::less<>> own = {"freeplay", "name",   "urdf",       "bodies",
                                                             "frames",   "joints", "parameters", "presets"};
      if (!own.contains(entry.key->text) && !is_note(entry.key->text) && !is_empty(*entry.value)) rest.push_back(entry);
    }
    put(root, "urdf", scalar(urdf_file_));
    Node& content = map();
    content.entries = rest;
    if (!joints.entries.empty()) put(content, "joints", joints);
    KeptSections kept(*source_, target_);
    kept.add_presets(root, content);
    if (kept.add_parameters(root, content)) {
      notes_.push_back("bodies and frames are written as numbers: parameters no longer change them");
    }
    // A URDF with a joint of the type floating is read in space unless the reader is asked for the plane.
    const bool floats = std::ranges::any_of(tree_joint_, [](int joint) { return joint < 0; });
    if (floats && source_->find("space") == nullptr) put(root, "space", scalar("planar"));
    const bool needed = floats || !bodies.entries.empty() || !joints.entries.empty() || !rest.empty();
    if (!needed) return false;
    root.entries.insert(root.entries.end(), rest.begin(), rest.end());
    if (!bodies.entries.empty()) put(root, "bodies", bodies);
    if (!joints.entries.empty()) put(root, "joints", joints);
    target_.set_root(root);
    return true;
  }

  static bool is_empty(const Node& node) { return node.is_null() || (node.is_map() && node.entries.empty()); }

  const Node& body_section() {
    const bool at_zero = stands_at_zero();
    for (std::size_t i = 0; i < q_.size(); ++i) {
      double& scale = i % 3 == 2 ? turning_ : moving_;
      scale = std::max(scale, std::abs(v_[i]));
      if (i % 3 != 2) size_ = std::max(size_, std::abs(q_[i]));
    }
    Node& section = map();
    Node& base = map();
    put_frames(base, ground);
    if (!base.entries.empty()) put(section, "ground", base);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const auto id = static_cast<BodyId>(b);
      Node& entry = map();
      const Place place = start(id);
      if (!at_zero) {
        Node& pose = map();
        put(pose, "position", point(clean(place.x, size_), clean(place.y, size_)));
        put(pose, "angle", scalar(n(clean(place.angle, 1.0))));
        put(entry, "pose", pose);
      }
      put_velocity(entry, id, place);
      put_frames(entry, id);
      if (!entry.entries.empty()) put(section, model_.bodies[b].name, entry);
    }
    return section;
  }

  /// Rounding left by the assembly is nothing to show to people.
  static double clean(double value, double scale) { return std::abs(value) <= 1e-14 * scale ? 0.0 : value; }

  /// Does every body of the tree stand where coordinates zero put it?
  bool stands_at_zero() const {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      if (tree_joint_[b] < 0) continue;
      const JointElement& joint = model_.joints[at(tree_joint_[b])];
      const BodyId parent = first(joint).body;
      const Place base = parent == ground ? Place{} : start(parent), own = origin(joint);
      const Place zero = compose(base, own.x, own.y, own.angle), is = start(static_cast<BodyId>(b));
      if (!same(zero.x, is.x) || !same(zero.y, is.y) || !same(zero.angle, is.angle)) return false;
    }
    return true;
  }

  void put_velocity(Node& entry, BodyId id, const Place& place) {
    const std::size_t b = at(id);
    const double vx = v_[3 * b], vy = v_[3 * b + 1], w = v_[3 * b + 2];
    if (clean(vx, moving_) == 0.0 && clean(vy, moving_) == 0.0 && clean(w, turning_) == 0.0) return;
    const double rx = place.x - q_[3 * b], ry = place.y - q_[3 * b + 1];
    Node& velocity = map();
    put(velocity, "linear", point(clean(vx - w * ry, moving_), clean(vy + w * rx, moving_)));
    put(velocity, "angular", scalar(n(clean(w, turning_))));
    put(entry, "velocity", velocity);
  }

  /// The frames of a body, but for those that the joints of the tree bring.
  void put_frames(Node& entry, BodyId body) {
    const std::string stem = (body == ground ? "ground" : model_.bodies[at(body)].name) + "/";
    const Place moved = shift(body);
    Node& frames = map();
    for (auto one = std::ranges::lower_bound(model_.frames, stem, {}, &Marker::name);
         one != model_.frames.end() && one->name.starts_with(stem); ++one) {
      const std::string name = one->name.substr(stem.size());
      if (name == "origin" || name == "com" || is_brought(body, name) || is_spent(one->name)) continue;
      Node& position = point(one->position[0] - moved.x, one->position[1] - moved.y);
      if (one->angle == 0.0) {
        put(frames, name, position);
        continue;
      }
      Node& map_form = map();
      put(map_form, "position", position);
      put(map_form, "angle", scalar(n(one->angle)));
      put(frames, name, map_form);
    }
    if (const auto own = origins_.find(body); own != origins_.end())
      put(frames, own->second, point(-moved.x, -moved.y));
    if (!frames.entries.empty()) put(entry, "frames", frames);
  }

  bool is_brought(BodyId body, const std::string& name) const {
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (!in_tree_[j] || model_.joints[j].name != name) continue;
      return first(model_.joints[j]).body == body || second(model_.joints[j]).body == body;
    }
    return false;
  }

  /// Whether joints of the tree alone used a frame: what they do there the URDF says.
  bool is_spent(const std::string& frame) const {
    bool used = false;
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const JointElement& joint = model_.joints[j];
      if (first(joint).name != frame && second(joint).name != frame) continue;
      if (!in_tree_[j]) return false;
      used = true;
    }
    return used && std::ranges::none_of(source_->entries, [&](const Node::Entry& entry) {
             const std::string& section = entry.key->text;
             return section != "bodies" && section != "frames" && section != "joints" && mentions(*entry.value, frame);
           });
  }

  const Node& joint_section() {
    Node& section = map();
    const Node* joints = source_->find("joints");
    if (joints == nullptr || !joints->is_map()) return section;
    for (const Node::Entry& entry : joints->entries) {
      if (is_note(entry.key->text)) continue;
      const auto found = std::ranges::find(model_.joints, entry.key->text, &JointElement::name);
      if (found == model_.joints.end()) continue;
      if (!in_tree_[static_cast<std::size_t>(found - model_.joints.begin())]) {
        section.entries.push_back(entry);
        continue;
      }
      const Node* clearance = with_presets(*entry.value, "clearance");
      if (clearance == nullptr) continue;
      Node& own = map();
      put(own, "clearance", *clearance);
      put(section, entry.key->text, own);
    }
    return section;
  }

  /// The value of a key that an entry has itself or from a preset that it uses.
  const Node* with_presets(const Node& entry, const std::string& key) const {
    if (!entry.is_map()) return nullptr;
    if (const Node* own = entry.find(key)) return own;
    const Node* use = entry.find("use");
    const Node* presets = source_->find("presets");
    if (use == nullptr || presets == nullptr) return nullptr;
    const std::vector<const Node*> names = use->is_list() ? use->items : std::vector<const Node*>{use};
    for (auto name = names.rbegin(); name != names.rend(); ++name) {  // a later preset wins
      const Node* preset = presets->find((*name)->text);
      const Node* found = preset == nullptr ? nullptr : with_presets(*preset, key);
      if (found != nullptr) return found;
    }
    return nullptr;
  }

  const Document& document_;
  const Node* source_ = nullptr;  ///< root of the document, references made fit
  const Model& model_;
  const Readout& readout_;
  std::span<const double> q_, v_;
  std::string urdf_file_;
  Document target_;
  std::vector<int> tree_joint_;  ///< of each body; -1: it floats
  std::map<std::string, BodyId> body_ids_;
  std::map<BodyId, std::string> origins_;             ///< frames where origins were that are referred to
  std::vector<bool> in_tree_;                         ///< of each joint
  double size_ = 0.0, moving_ = 0.0, turning_ = 0.0;  ///< largest coordinate [m] and speeds at the start
  std::vector<std::string> notes_;
};

}  // namespace

UrdfText write_urdf(const Document& document, const Model& model, const Readout& readout, std::span<const double> q,
                    std::span<const double> v, const std::string& urdf_file) {
  return UrdfWriter(document, model, readout, q, v, urdf_file).write();
}

}  // namespace freeplay
