// The joints of the library, one row each.
#include "freeplay/plugin.h"

namespace freeplay {
Component revolute();
Component prismatic();
Component fixed();
Component point_on_line();
Component distance();
Component spring_damper();
Component revolute_clearance();
Component prismatic_clearance();
Component point_on_line_clearance();
Component gear_clearance();
Component spherical();
Component universal();
Component cylindrical();
Component planar_joint();
Component spherical_clearance();
Component cylindrical_clearance();
Component universal_clearance();
Component bushing();
Component joint_friction();
Component joint_stop();
Component point_on_plane();
Component revolute_spherical();
Component screw();
Component belt();
Component brake();
Component one_way_clutch();
Component point_on_curve();
Component point_on_curve_lift_off();
Component slot_contact();
Component arc_contact();
Component curve_contact();
}  // namespace freeplay

FREEPLAY_PLUGIN(joints) {
  using namespace freeplay;
  static const Component components[] = {revolute(),
                                         prismatic(),
                                         fixed(),
                                         point_on_line(),
                                         distance(),
                                         spring_damper(),
                                         revolute_clearance(),
                                         prismatic_clearance(),
                                         point_on_line_clearance(),
                                         gear_clearance(),
                                         spherical(),
                                         universal(),
                                         cylindrical(),
                                         planar_joint(),
                                         spherical_clearance(),
                                         cylindrical_clearance(),
                                         universal_clearance(),
                                         bushing(),
                                         joint_friction(),
                                         joint_stop(),
                                         point_on_plane(),
                                         revolute_spherical(),
                                         screw(),
                                         belt(),
                                         brake(),
                                         one_way_clutch(),
                                         point_on_curve(),
                                         point_on_curve_lift_off(),
                                         slot_contact(),
                                         arc_contact(),
                                         curve_contact()};
  return publish(*host, *manifest, "joints", "0.1.0", components);
}
