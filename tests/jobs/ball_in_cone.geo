// A ball in a conical seat, axisymmetric: x = r, y = z, the axis at x = 0. The seat is a ring whose bore is a cone.
// Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  radius = {5, Name "of the ball"}, half_angle = {45, Name "of the cone against its axis, degrees"}
];
fine = 0.04 / refine;
coarse = 1 / refine;
a = half_angle * Pi / 180;
s = 0.5 / radius; // half of the finely meshed length, as an angle of the ball
Function OnBall // point p at angle w below the equator
  Point(p) = {radius * Cos(w), -radius * Sin(w), 0, size};
Return
Point(1) = {0, 0, 0, coarse};
p = 2; w = Pi / 2; size = coarse; Call OnBall;
p = 3; w = a + s; size = fine; Call OnBall;
p = 4; w = a; Call OnBall;
p = 5; w = a - s; Call OnBall;
p = 6; w = 0; size = coarse; Call OnBall;
p = 7; w = -Pi / 2; Call OnBall;
For i In {1 : 5}
  Circle(i) = {i + 1, 1, i + 2};
EndFor
Line(6) = {7, 1};
Line(7) = {1, 2};
Curve Loop(1) = {1 : 7};
Plane Surface(1) = {1};

rc = radius * Cos(a); // the ball touches the cone here
zc = -radius * Sin(a);
Function OnCone // point p at distance w from the touch, along the cone
  Point(p) = {rc + w * Sin(a), zc + w * Cos(a), 0, size};
Return
p = 11; w = -2.5; size = coarse; Call OnCone;
p = 12; w = -0.5; size = fine; Call OnCone;
p = 13; w = 0.5; Call OnCone;
p = 14; w = 2.5; size = coarse; Call OnCone;
Point(15) = {9, zc + 2.5 * Cos(a), 0, coarse};
Point(16) = {9, zc - 5, 0, coarse};
Point(17) = {rc - 2.5 * Sin(a), zc - 5, 0, coarse};
For i In {11 : 16}
  Line(i) = {i, i + 1};
EndFor
Line(17) = {17, 11};
Curve Loop(2) = {-17 : -11}; // counterclockwise
Plane Surface(2) = {2};

Physical Surface("ball") = {1};
Physical Surface("seat") = {2};
Physical Curve("ball_skin") = {1 : 4};
Physical Curve("ball_top") = {5};
Physical Curve("axis") = {6, 7};
Physical Curve("bore") = {11 : 13};
Physical Curve("seat_bottom") = {16};
