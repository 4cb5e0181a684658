# SPDX-License-Identifier: Apache-2.0
# godot --script godot.gd: Godot 4 draws each case of cases.json in the current folder, as page.js has engines of the
# web do it. Models and maps are those that the project has imported; the place says where a map is read as it is.
extends SceneTree

var view := SubViewport.new()
var light := DirectionalLight3D.new()

func _initialize():
	run()

func texture_of(case):
	if not case.place.contains("Image"):
		return load("res://" + case.map)
	var image := Image.load_from_file(case.map)
	if image == null:
		return null
	image.generate_mipmaps()
	return ImageTexture.create_from_image(image)

func surface(case):
	var map = texture_of(case) if case.map else null
	if case.map and map == null:
		return null
	if not case.model:
		var material := StandardMaterial3D.new()
		material.albedo_color = Color(0.6, 0.6, 0.6)
		material.roughness = 1
		material.normal_enabled = true
		material.normal_texture = map
		if case.place.contains("Lambert"):
			material.diffuse_mode = BaseMaterial3D.DIFFUSE_LAMBERT
			material.specular_mode = BaseMaterial3D.SPECULAR_DISABLED
		var plane := MeshInstance3D.new()
		plane.mesh = QuadMesh.new()
		plane.mesh.size = Vector2(2, 2)
		plane.material_override = material
		return plane
	var scene = load("res://" + case.model)
	if scene == null:
		return null
	var root = scene.instantiate()
	if map:
		root.find_children("*", "MeshInstance3D")[0].get_active_material(0).normal_texture = map
	return root

func run():
	var job = JSON.parse_string(FileAccess.get_file_as_string("cases.json"))
	view.size = Vector2i(int(job.side), int(job.side))
	view.own_world_3d = true
	view.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	get_root().add_child(view)
	var camera := Camera3D.new()
	camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	camera.size = 2
	camera.position = Vector3(0, 0, 10)
	camera.environment = Environment.new()
	camera.environment.background_mode = Environment.BG_COLOR
	camera.environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
	view.add_child(camera)
	view.add_child(light)
	for case in job.cases:
		var shown = surface(case)
		if shown == null:
			FileAccess.open(case.id + ".txt", FileAccess.WRITE).store_string("not read")
			continue
		view.add_child(shown)
		for name in job.lights:
			var at = job.lights[name]
			light.look_at_from_position(Vector3(at[0], at[1], at[2]), Vector3(), Vector3.UP)
			for _frame in range(3):
				await process_frame
			var picture := view.get_texture().get_image()
			picture.convert(Image.FORMAT_L8)
			FileAccess.open(case.id + "." + name + ".grey", FileAccess.WRITE).store_buffer(picture.get_data())
		shown.free()
	quit()
