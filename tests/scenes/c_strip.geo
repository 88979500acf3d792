// A frame that is open at the right, between two flat tips; plane. Form 0: the whole frame; 1: its upper half; 2: the
// whole frame as two bodies that are cut along the middle of its back.
DefineConstant[
  form = {0, Name "0: whole, 1: upper half, 2: whole, cut in two"}, gap = {0.002, Name "between the tips"},
  width = {10, Name "of the frame"}, height = {6, Name "of the frame"}, wall = {1, Name "thickness"},
  n = {4, Name "elements across the wall"}
];
// the upper half: back, arm and tip, each side a row of points from the outside in
For side In {0:1}
  s = 1 - 2 * side;
  b = 100 * side;
  g = gap / 2;
  Point(b + 1) = {0, 0, 0};
  Point(b + 2) = {wall, 0, 0};
  Point(b + 3) = {0, s * (height / 2 - wall), 0};
  Point(b + 4) = {wall, s * (height / 2 - wall), 0};
  Point(b + 5) = {0, s * height / 2, 0};
  Point(b + 6) = {wall, s * height / 2, 0};
  Point(b + 7) = {width - wall, s * (height / 2 - wall), 0};
  Point(b + 8) = {width - wall, s * height / 2, 0};
  Point(b + 9) = {width, s * (height / 2 - wall), 0};
  Point(b + 10) = {width, s * height / 2, 0};
  Point(b + 11) = {width - wall, s * g, 0};
  Point(b + 12) = {width, s * g, 0};
EndFor
// the halves of a whole frame share the two points of the cut
Macro Half
  p1 = b + 1;
  p2 = b + 2;
  If (side && form == 0)
    p1 = 1;
    p2 = 2;
  EndIf
  Line(b + 1) = {p1, p2};
  Line(b + 2) = {p2, b + 4};
  Line(b + 3) = {b + 4, b + 3};
  Line(b + 4) = {b + 3, p1};
  Line(b + 5) = {b + 3, b + 5};
  Line(b + 6) = {b + 5, b + 6};
  Line(b + 7) = {b + 6, b + 4};
  Line(b + 8) = {b + 4, b + 7};
  Line(b + 9) = {b + 7, b + 8};
  Line(b + 10) = {b + 8, b + 6};
  Line(b + 11) = {b + 7, b + 9};
  Line(b + 12) = {b + 9, b + 10};
  Line(b + 13) = {b + 10, b + 8};
  Line(b + 14) = {b + 7, b + 11};
  Line(b + 15) = {b + 11, b + 12};
  Line(b + 16) = {b + 12, b + 9};
  first = b + 1;
  If (side && form == 0)
    first = 1;
  EndIf
  Curve Loop(b + 1) = {first, b + 2, b + 3, b + 4};
  Curve Loop(b + 2) = {-(b + 3), -(b + 7), -(b + 6), -(b + 5)};
  Curve Loop(b + 3) = {b + 8, b + 9, b + 10, b + 7};
  Curve Loop(b + 4) = {b + 11, b + 12, b + 13, -(b + 9)};
  Curve Loop(b + 5) = {b + 14, b + 15, b + 16, -(b + 11)};
  For k In {1:5}
    Plane Surface(b + k) = {b + k};
  EndFor
  Transfinite Curve{b + 1, b + 3, b + 6, b + 5, b + 7, b + 9, b + 11, b + 12, b + 13, b + 15} = n + 1;
  Transfinite Curve{b + 2, b + 4, b + 14, b + 16} = 2 * n + 1;
  Transfinite Curve{b + 8, b + 10} = 6 * n + 1;
Return
b = 0;
side = 0;
Call Half;
If (form != 1)
  b = 100;
  side = 1;
  Call Half;
  If (form == 0)
    Recursive Delete{ Curve{101}; }
  EndIf
EndIf
Transfinite Surface{:};
Recombine Surface{:};
upper[] = {1:5};
lower[] = {101:105};
skin[] = {2, 4, 5, 6, 8, 10, 12, 13, 14, 15, 16};
Physical Curve("top") = {10};
Physical Curve("tip") = {15};
Physical Curve("back") = {1};
If (form == 0)
  Physical Surface("frame") = {upper[], lower[]};
  Physical Curve("bottom") = {110};
  Physical Curve("tips") = {15, 115};
  Physical Curve("skin") = {skin[], 102, 104, 105, 106, 108, 110, 112, 113, 114, 115, 116};
EndIf
If (form == 1)
  Physical Surface("frame") = {upper[]};
EndIf
If (form == 2)
  Physical Surface("frame") = {upper[]};
  Physical Surface("lower") = {lower[]};
  Physical Curve("bottom") = {110};
  Physical Curve("lower_tip") = {115};
  Physical Curve("lower_back") = {101};
EndIf
