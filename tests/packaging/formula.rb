# SPDX-License-Identifier: Apache-2.0
# ruby formula.rb FORMULA STAGE SCRATCH PICTURE: runs `install` of a Homebrew formula and records the commands that it
# would start. Then runs its test with the installation STAGE, in the folder SCRATCH. Prints what the formula declares
# and the recorded commands, as JSON.
require "json"
require "pathname"

FORMULA, STAGE, SCRATCH, PICTURE = ARGV.map { |argument| Pathname(argument) }

# What the formula uses of Homebrew.
class Formula
  DECLARED = { "dependencies" => [] }

  class << self
    %w[desc license].each { |name| define_method(name) { |value| DECLARED[name] = value } }
    def head(url, **how) = DECLARED["head"] = [url, how]
    def depends_on(what) = DECLARED["dependencies"] << (what.is_a?(Hash) ? what.keys.first : what)
    def test(&steps) = DECLARED["test"] = steps
  end

  def prefix = STAGE
  def bin = STAGE/"bin"
  def testpath = SCRATCH
  def test_fixtures(_name) = PICTURE
  def std_cmake_args = []
  def system(*words) = @started ? (@started << words) : (Kernel.system(*words.map(&:to_s)) || raise("#{words} failed"))
  def shell_output(command) = `#{command}`.tap { raise "#{command} failed" unless $?.success? }
  def assert_match(wanted, text) = text.include?(wanted) || raise("#{text} does not have #{wanted}")
  def assert_path_exists(path) = path.exist? || raise("#{path} is missing")

  def record_install
    @started = []
    install
    @started.tap { @started = nil }
  end
end

load FORMULA
formula = Libtex.new
started = formula.record_install
steps = Formula::DECLARED.delete("test")
Dir.chdir(SCRATCH) { formula.instance_exec(&steps) }
puts JSON.generate(Formula::DECLARED.merge("started" => started, "commands" => Libtex::COMMANDS))
