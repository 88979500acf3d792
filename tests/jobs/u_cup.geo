// The meridian plane of a U-cup around a rod, in a bore; x = r, y = z. Both lips overlap their partner by 0.5. Rod, bore
// and the step that holds the back are curves. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 0.25 / refine; coarse = 0.4 / refine;
Point(1) = {20.15, 0, 0, coarse}; Point(2) = {25.85, 0, 0, coarse};
Point(3) = {25.85, 4, 0, coarse}; Point(4) = {26.5, 7.2, 0, fine}; Point(5) = {25.9, 8, 0, fine}; Point(6) = {24.8, 7.6, 0, fine};
Point(7) = {23.7, 4.4, 0, coarse}; Point(8) = {23, 3.9, 0, coarse}; Point(9) = {22.3, 4.4, 0, coarse};
Point(10) = {21.2, 7.6, 0, fine}; Point(11) = {20.1, 8, 0, fine}; Point(12) = {19.5, 7.2, 0, fine}; Point(13) = {20.15, 4, 0, coarse};
For i In {1 : 13}
  Line(i) = {i, i % 13 + 1};
EndFor
Curve Loop(1) = {1 : 13}; Plane Surface(1) = {1};
Point(21) = {20, -2, 0}; Point(22) = {20, 12, 0}; Point(23) = {26, -2, 0}; Point(24) = {26, 12, 0};
Point(25) = {18, 0, 0}; Point(26) = {28, 0, 0};
Line(21) = {21, 22}; Line(22) = {23, 24}; Line(23) = {25, 26};
Physical Surface("cup") = {1};
Physical Curve("skin") = {1 : 13};
Physical Curve("rod") = {21}; Physical Curve("bore") = {22}; Physical Curve("step") = {23};
