// Meridian of a ring, and of the jaws around it: x = r, y = z. Lengths in mm.
DefineConstant[ n = {4, Name "elements through the wall"} ];
Point(1) = {4, 0, 0}; Point(2) = {6, 0, 0}; Point(3) = {6, 3, 0}; Point(4) = {4, 3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = Round(1.5 * n) + 1;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
Point(11) = {6.1, -1, 0}; Point(12) = {6.1, 4, 0};
Line(11) = {11, 12};
Physical Surface("ring") = {1};
Physical Curve("outer") = {2};
Physical Curve("ends") = {1, 3};
Physical Curve("jaws") = {11};
