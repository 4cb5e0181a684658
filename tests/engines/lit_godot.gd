# SPDX-License-Identifier: Apache-2.0
# godot3 -s lit_godot.gd FOLDER MAP PICTURE SIDE: draws the sphere of FOLDER/sphere.json with a normal map under a light.
extends SceneTree

func vectors(values, width):
	var result = []
	for k in range(0, values.size(), width):
		result.append(Vector2(values[k], values[k + 1]) if width == 2 else Vector3(values[k], values[k + 1], values[k + 2]))
	return result

func sphere(path):
	var file = File.new()
	file.open(path, File.READ)
	var data = JSON.parse(file.get_as_text()).result
	var arrays = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = PoolVector3Array(vectors(data.normals, 3))
	arrays[Mesh.ARRAY_NORMAL] = arrays[Mesh.ARRAY_VERTEX]
	arrays[Mesh.ARRAY_TANGENT] = PoolRealArray(data.tangents)
	arrays[Mesh.ARRAY_TEX_UV] = PoolVector2Array(vectors(data.uvs, 2))
	var indices = []
	for k in range(0, data.indices.size(), 3): # clockwise in Godot
		for corner in [0, 2, 1]:
			indices.append(int(data.indices[k + corner]))
	arrays[Mesh.ARRAY_INDEX] = PoolIntArray(indices)
	var mesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [], 0)
	return mesh

func material(path):
	var image = Image.new()
	assert(image.load(path) == OK)
	var texture = ImageTexture.new()
	texture.create_from_image(image)
	var result = SpatialMaterial.new()
	var grey = 1.055 * pow(0.6, 1 / 2.4) - 0.055 # the colour is in sRGB
	result.albedo_color = Color(grey, grey, grey)
	result.normal_enabled = true
	result.normal_texture = texture
	result.roughness = 1
	result.metallic_specular = 0
	result.params_diffuse_mode = SpatialMaterial.DIFFUSE_LAMBERT
	result.params_specular_mode = SpatialMaterial.SPECULAR_DISABLED
	return result

func _initialize():
	var arguments = OS.get_cmdline_args()
	arguments = Array(arguments).slice(arguments.size() - 4, arguments.size() - 1)
	var view = Viewport.new()
	view.size = Vector2(int(arguments[3]), int(arguments[3]))
	view.msaa = Viewport.MSAA_4X
	view.hdr = true
	view.own_world = true
	view.render_target_update_mode = Viewport.UPDATE_ALWAYS
	get_root().add_child(view)
	var body = MeshInstance.new()
	body.mesh = sphere(arguments[0] + "/sphere.json")
	body.material_override = material(arguments[1])
	view.add_child(body)
	var camera = Camera.new()
	camera.projection = Camera.PROJECTION_ORTHOGONAL
	camera.size = 2.12
	camera.translation = Vector3(0, 0, 10)
	camera.environment = Environment.new()
	camera.environment.background_mode = Environment.BG_COLOR
	camera.environment.ambient_light_color = Color(0, 0, 0)
	camera.environment.ambient_light_energy = 0
	view.add_child(camera)
	var light = DirectionalLight.new()
	light.light_specular = 0
	view.add_child(light)
	light.look_at_from_position(Vector3(-0.8, 1, 1.2), Vector3(), Vector3.UP)
	for _frame in range(3):
		yield(self, "idle_frame")
	var picture = view.get_texture().get_data()
	picture.flip_y()
	picture.convert(Image.FORMAT_RGB8)
	assert(picture.save_png(arguments[2]) == OK)
	quit()
