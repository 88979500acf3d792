// A cylindrical punch with a rounded edge on a foundation, half of the meridian: x is the radius. Lengths in mm.
DefineConstant[ h = {1, Name "element size at the edge of contact"}, coarse = {12, Name "far from it, over h"}, ratio = {0.8, Name "the foundation's sizes over the punch's"} ];
SetFactory("OpenCASCADE"); // the built-in kernel would merge the two bodies' coincident points
far = coarse * h;
Point(1) = {0, 0, 0, 4 * h};
Point(2) = {40, 0, 0, h};
Point(3) = {50, 10, 0, 4 * h};
Point(4) = {50, 100, 0, far};
Point(5) = {0, 100, 0, far};
Point(6) = {40, 10, 0};
Line(1) = {1, 2};
Circle(2) = {2, 6, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 : 5};
Plane Surface(1) = {1};
Point(11) = {0, -200, 0, far};
Point(12) = {100, -200, 0, far};
Point(13) = {100, 0, 0, far};
Point(14) = {41, 0, 0, ratio * h};
Point(15) = {0, 0, 0, 4 * ratio * h};
For k In {1 : 5}
  Line(10 + k) = {10 + k, 11 + k % 5};
EndFor
Curve Loop(11) = {11 : 15};
Plane Surface(11) = {11};
Recombine Surface{:};
Physical Surface("punch") = {1};
Physical Surface("foundation") = {11};
Physical Curve("punch_sole") = {1, 2};
Physical Curve("punch_top") = {4};
Physical Curve("foundation_top") = {13, 14};
Physical Curve("foundation_bottom") = {11};
