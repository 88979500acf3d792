// Section of a C-shaped metal seal, open to the axis, axisymmetric, x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.3 / refine;
c = 50; z = 3; outer = 3; inner = 2.4; a = 30 * Pi / 180; // half the angle of its mouth
Point(1)={c,z,0,h};
Point(2)={c-outer*Cos(a),z+outer*Sin(a),0,h}; Point(3)={c,z+outer,0,h}; Point(4)={c+outer,z,0,h};
Point(5)={c,z-outer,0,h}; Point(6)={c-outer*Cos(a),z-outer*Sin(a),0,h};
Point(7)={c-inner*Cos(a),z+inner*Sin(a),0,h}; Point(8)={c,z+inner,0,h}; Point(9)={c+inner,z,0,h};
Point(10)={c,z-inner,0,h}; Point(11)={c-inner*Cos(a),z-inner*Sin(a),0,h};
Circle(1)={2,1,3}; Circle(2)={3,1,4}; Circle(3)={4,1,5}; Circle(4)={5,1,6}; Line(5)={6,11};
Circle(6)={11,1,10}; Circle(7)={10,1,9}; Circle(8)={9,1,8}; Circle(9)={8,1,7}; Line(10)={7,2};
Curve Loop(1)={1:10}; Plane Surface(1)={1};
Physical Surface("ring")={1}; Physical Curve("outside")={1:4}; Physical Curve("inside")={5:10};
