# SPDX-License-Identifier: Apache-2.0
# godot --headless --script godot_bake.gd: what Image.bump_map_to_normal_map() makes of a flat map, of one higher texel
# and of rows that rise over an odd number of them, as sentences in baked.txt.
extends SceneTree

func baked(size, height):
	var image := Image.create_empty(size.x, size.y, false, Image.FORMAT_L8)
	for y in range(size.y):
		for x in range(size.x):
			var code = height.call(x, y)
			image.set_pixel(x, y, Color8(code, code, code))
	image.bump_map_to_normal_map(1)
	return image

func codes(color):
	return "%d %d %d" % [color.r8, color.g8, color.b8]

func _initialize():
	var file := FileAccess.open("baked.txt", FileAccess.WRITE)
	var flat = baked(Vector2i(8, 8), func(_x, _y): return 100)
	file.store_line("* A flat height map is %s everywhere." % codes(flat.get_pixel(3, 3)))
	var spike = baked(Vector2i(8, 8), func(x, y): return 51 if x == 4 and y == 4 else 0)
	var seen = []
	for y in range(8):
		for x in range(8):
			if codes(spike.get_pixel(x, y)) != codes(flat.get_pixel(3, 3)):
				seen.append("(%d, %d) %s" % [x - 4, y - 4, codes(spike.get_pixel(x, y))])
	file.store_line("* One texel that is higher by 51 codes, at (0, 0), changes these: %s." % ", ".join(seen))
	var rows = baked(Vector2i(8, 7), func(_x, y): return 20 * y)
	file.store_line("* Seven rows that are 20 codes higher each are %s; the last, which meets the first, %s." %
		[codes(rows.get_pixel(3, 3)), codes(rows.get_pixel(3, 6))])
	quit()
