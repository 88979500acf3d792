// Five turns of a thread of pitch 2 and their nut, axisymmetric: x is the radius; the flanks are 0.02 apart
DefineConstant[
  refine = {1, Name "divides all element sizes"}
];
pitch = 2; turns = 5; root = 4; crest = 5.1; slope = Tan(Pi/6); top = 0.25; // of the bolt; top: width of a crest
rise = (crest - root)*slope;
inner = 4.2; outer = 5.25; gap = 0.02; back = 0.25; // of the nut; back: play behind a thread

bolt[] = {};
p = newp; Point(p) = {0, -8, 0}; bolt[] += p;
p = newp; Point(p) = {root, -8, 0}; bolt[] += p;
For i In {0 : turns - 1}
  y = i*pitch + 0.15;
  p = newp; Point(p) = {root, y, 0}; bolt[] += p;
  p = newp; Point(p) = {crest, y + rise, 0}; bolt[] += p;
  p = newp; Point(p) = {crest, y + rise + top, 0}; bolt[] += p;
  p = newp; Point(p) = {root, y + 2*rise + top, 0}; bolt[] += p;
EndFor
p = newp; Point(p) = {root, turns*pitch + 1, 0}; bolt[] += p;
p = newp; Point(p) = {0, turns*pitch + 1, 0}; bolt[] += p;

nut[] = {};
p = newp; Point(p) = {inner, 0, 0}; nut[] += p;
For i In {0 : turns - 1}
  y = i*pitch + 0.15;
  p = newp; Point(p) = {inner, y + (inner - root)*slope - gap, 0}; nut[] += p;
  p = newp; Point(p) = {outer, y + (outer - root)*slope - gap, 0}; nut[] += p;
  p = newp; Point(p) = {outer, y + 2*rise + top + back - (outer - root)*slope, 0}; nut[] += p;
  p = newp; Point(p) = {inner, y + 2*rise + top + back - (inner - root)*slope, 0}; nut[] += p;
EndFor
p = newp; Point(p) = {inner, turns*pitch, 0}; nut[] += p;
p = newp; Point(p) = {9, turns*pitch, 0}; nut[] += p;
p = newp; Point(p) = {9, 0, 0}; nut[] += p;

bolt_lines[] = {};
For i In {0 : #bolt[] - 1}
  l = newl; Line(l) = {bolt[i], bolt[(i + 1) % #bolt[]]}; bolt_lines[] += l;
EndFor
nut_lines[] = {};
For i In {0 : #nut[] - 1}
  l = newl; Line(l) = {nut[i], nut[(i + 1) % #nut[]]}; nut_lines[] += l;
EndFor
Curve Loop(1) = {bolt_lines[]};  Plane Surface(1) = {1};
Curve Loop(2) = {nut_lines[]};  Plane Surface(2) = {2};

Field[1] = Box;
Field[1].XMin = 3.6;  Field[1].XMax = 5.6;  Field[1].YMin = -1;  Field[1].YMax = 11;
Field[1].VIn = 0.25/refine;  Field[1].VOut = 1/refine;  Field[1].Thickness = 2;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("bolt") = {1};
Physical Surface("nut") = {2};
Physical Curve("pull") = {bolt_lines[0]};
Physical Curve("axis") = {bolt_lines[#bolt_lines[] - 1]};
Physical Curve("bolt_thread") = {bolt_lines[{2 : #bolt_lines[] - 4}]};
Physical Curve("nut_thread") = {nut_lines[{0 : #nut_lines[] - 4}]};
Physical Curve("seat") = {nut_lines[#nut_lines[] - 1]};
