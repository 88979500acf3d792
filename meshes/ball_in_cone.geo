// The lower half of a ball in a cone of 90 degrees about the axis y: the meridian plane (solid = 0), or a quarter of the bodies
// (solid = 1, tetrahedra). The first touch is a circle of radius r_ball / Sqrt(2). Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[
  solid = {0, Name "1: a quarter of the bodies in 3D, 0: their meridian plane"},
  h_ball = {0.9, Name "element size, ball"}, h_cone = {1.1, Name "element size, cone"},
  shift = {0, Name "moves the ball off the cone"}
];
r_ball = 10;
y = r_ball * Sqrt(2) + shift;
Point(1) = {0, y, 0};
Point(2) = {0, y - r_ball, 0};
Point(3) = {r_ball, y, 0};
Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Point(11) = {4, 4, 0};
Point(12) = {11, 11, 0};
Point(13) = {16, 11, 0};
Point(14) = {16, -2, 0};
Point(15) = {4, -2, 0};
Line(11) = {12, 11};
Line(12) = {13, 12};
Line(13) = {14, 13};
Line(14) = {15, 14};
Line(15) = {11, 15};
Curve Loop(11) = {15, 14, 13, 12, 11};
Plane Surface(11) = {11};
If (solid)
  ball[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2} { Surface{1}; };
  cone[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2} { Surface{11}; };
  Characteristic Length{PointsOf{Volume{ball[1]};}} = h_ball;
  Characteristic Length{PointsOf{Volume{cone[1]};}} = h_cone;
  Physical Volume("ball") = {ball[1]};
  Physical Volume("cone") = {cone[1]};
  e = 1e-3;
  Physical Surface("sides_z") = {1, 11};
  Physical Surface("sides_x") = {ball[0], cone[0]};
  Physical Surface("ball_sole") = {ball[2]};
  Physical Surface("ball_cut") = {ball[3]};
  Physical Surface("cone_bottom") = {cone[3]};
  Physical Surface("cone_seat") = {cone[6]};
Else
  Characteristic Length{1, 2, 3} = h_ball;
  Characteristic Length{11 : 15} = h_cone;
  Recombine Surface{1, 11};
  Mesh.Algorithm = 6;
  Physical Surface("ball") = {1};
  Physical Surface("cone") = {11};
  Physical Curve("ball_sole") = {2};
  Physical Curve("ball_cut") = {3};
  Physical Curve("cone_bottom") = {14};
  Physical Curve("cone_seat") = {11};
EndIf
