// A block above the right edge of another one, which is sharp, or rounded by some faces; plane or solid. Skins are the surfaces that may meet.
SetFactory("OpenCASCADE");
DefineConstant[
  solid = {0, Name "1: extruded along z, 0: plane"},
  radius = {0, Name "radius of the edge; 0: sharp"}, faces = {2, Name "faces over the rounding"},
  left = {-4, Name "left side of the upper block; the edge is at x = 0"}, width = {6, Name "width of the upper block"},
  gap = {0.05, Name "gap between the blocks"},
  size_upper = {0.5, Name "element size of the upper block"}, size_lower = {0.5, Name "element size of the lower one"},
  depth = {1, Name "depth"}, n_depth = {2, Name "elements along z"}
];
Point(1) = {-8, -5, 0, 2 * size_lower};
Point(2) = {0, -5, 0, 2 * size_lower};
Point(3) = {0, -radius, 0, size_lower};
Point(4) = {-radius, 0, 0, size_lower};
Point(5) = {-8, 0, 0, size_lower};
Line(1) = {1, 2};
Line(2) = {2, 3};
If (radius > 0)
  Point(6) = {-radius, -radius, 0};
  Circle(3) = {3, 6, 4};
  Transfinite Curve{3} = faces + 1;
  Line(4) = {4, 5};
Else
  Line(4) = {3, 5};
EndIf
Line(5) = {5, 1};
If (radius > 0)
  Curve Loop(1) = {1, 2, 3, 4, 5};
Else
  Curve Loop(1) = {1, 2, 4, 5};
EndIf
Plane Surface(1) = {1};
Point(11) = {left, gap, 0, size_upper};
Point(12) = {left + width, gap, 0, size_upper};
Point(13) = {left + width, gap + 4, 0, 2 * size_upper};
Point(14) = {left, gap + 4, 0, 2 * size_upper};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Recombine Surface{1, 2};
If (solid)
  low[] = Extrude{0, 0, depth}{ Surface{1}; Layers{n_depth}; Recombine; };
  up[] = Extrude{0, 0, depth}{ Surface{2}; Layers{n_depth}; Recombine; };
  n = #low[] - 1; // the last one is the left side
  Physical Volume("lower") = {low[1]};
  Physical Volume("upper") = {up[1]};
  Physical Surface("lower_bottom") = {low[2]};
  Physical Surface("lower_skin") = {low[{3:n - 1}]};
  Physical Surface("lower_top") = {low[n - 1]};
  Physical Surface("upper_top") = {up[4]};
  Physical Surface("upper_sole") = {up[2]};
  Physical Surface("upper_skin") = {up[2], up[3], up[5]};
  Physical Surface("ends") = {1, 2, low[0], up[0]};
Else
  Physical Surface("lower") = {1};
  Physical Surface("upper") = {2};
  Physical Curve("lower_bottom") = {1};
  If (radius > 0)
    Physical Curve("lower_skin") = {2, 3, 4};
  Else
    Physical Curve("lower_skin") = {2, 4};
  EndIf
  Physical Curve("lower_top") = {4};
  Physical Curve("upper_top") = {13};
  Physical Curve("upper_sole") = {11};
  Physical Curve("upper_skin") = {11, 12, 14};
EndIf
