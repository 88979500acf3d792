// A spherical cap from its apex on the axis to 45 degrees (paper, section 5.3): axisymmetric, x = r, y = z, centre at the origin. Lengths in mm.
DefineConstant[
  n_arc = {120, Name "elements along the arc: 120 of first or 60 of second order"},
  n_wall = {2, Name "elements through the wall"}
];
r_in = 99; r_out = 101; s = Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {0, -r_out, 0};
Point(3) = {r_out * s, -r_out * s, 0};
Point(4) = {r_in * s, -r_in * s, 0};
Point(5) = {0, -r_in, 0};
Circle(1) = {2, 1, 3};
Line(2) = {3, 4};
Circle(3) = {4, 1, 5};
Line(4) = {5, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_arc + 1;
Transfinite Curve{2, 4} = n_wall + 1;
Transfinite Surface{1};
Recombine Surface{1};

Physical Surface("cup") = {1};
Physical Curve("outer") = {1};
Physical Curve("cut") = {2};
Physical Curve("inner") = {3};
Physical Curve("axis") = {4};
