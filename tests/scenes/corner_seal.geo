// The meridian plane of a ring with a flat foot and a round top, in a groove with right angles, under a lid. Groove and
// lid are curves. x = r, y = z; lengths in mm.
size = 0.25; w = 3.2; h = 3.6; r = 25; play = 0.4; deep = 2.9;
Point(1) = {r, 0, 0, size};
Point(2) = {r + w, 0, 0, size};
Point(3) = {r + w, h - w / 2, 0, size};
Point(4) = {r + w / 2, h - w / 2, 0, size};
Point(5) = {r, h - w / 2, 0, size};
Point(6) = {r + w / 2, h, 0, size};
Line(1) = {1, 2};
Line(2) = {2, 3};
Circle(3) = {3, 4, 6};
Circle(4) = {6, 4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 : 5};
Plane Surface(1) = {1};
Point(11) = {r - 2, deep, 0};
Point(12) = {r - play, deep, 0};
Point(13) = {r - play, 0, 0};
Point(14) = {r + w + play, 0, 0};
Point(15) = {r + w + play, deep, 0};
Point(16) = {r + w + 2, deep, 0};
For i In {11 : 15}
  Line(i) = {i, i + 1};
EndFor
Point(21) = {r - 2, h, 0};
Point(22) = {r + w + 2, h, 0};
Line(21) = {21, 22};
Physical Surface("ring") = {1};
Physical Curve("skin") = {1 : 5};
Physical Curve("groove") = {11 : 15};
Physical Curve("lid") = {21};
