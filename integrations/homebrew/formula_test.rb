# Runs the formula's install and test as Homebrew does, with a drypoint that is built already:
#   ruby formula_test.rb FORMULA DRYPOINT FOLDER
require "fileutils"
require "open3"
require "pathname"

FORMULA, DRYPOINT, FOLDER = ARGV.map { |argument| Pathname(argument).expand_path }

# What the formula says of itself, and the steps that it may take.
class Formula
  STANZAS = {}

  class << self
    %i[desc homepage url version sha256 license depends_on].each do |stanza|
      define_method(stanza) { |*values| STANZAS[stanza] = values.first }
    end

    def test(&block)
      define_method(:run_test, &block)
    end
  end

  def bin = FOLDER/"bin"
  def man1 = FOLDER/"share/man/man1"
  def share = FOLDER/"share"
  def opt_share = share
  def testpath = FOLDER/"test"
  def version = STANZAS.fetch(:version) { STANZAS.fetch(:url)[/\d+\.\d+\.\d+/] }
  def std_cargo_args = ["--locked", "--root=#{FOLDER}", "--path=."]

  def system(*command)
    return FileUtils.cp(DRYPOINT, bin.tap(&:mkpath)) if command.first == "cargo"

    Kernel.system(*command.map(&:to_s), exception: true)
  end

  def generate_completions_from_executable(program, *arguments)
    %w[bash zsh fish].each { |shell| Utils.safe_popen_read(program, *arguments, shell) }
  end

  def shell_output(command)
    `#{command}`
  end

  def assert_equal(expected, found)
    raise "expected #{expected.inspect}, found #{found.inspect}" unless expected == found
  end

  def assert_match(expected, found)
    raise "#{expected.inspect} was not found" unless found.include?(expected)
  end
end

module Utils
  def self.safe_popen_read(*command)
    said, status = Open3.capture2(*command.map(&:to_s))
    raise "#{command.join(" ")} failed" if !status.success? || said.empty?

    said
  end
end

class Pathname
  def install(sources)
    mkpath
    sources.each { |source| FileUtils.cp_r(source, self) }
  end
end

load FORMULA
formula = Drypoint.new
FileUtils.mkdir_p(formula.testpath)
formula.install
formula.run_test

missing = %i[desc homepage url sha256 license].reject { |stanza| Formula::STANZAS.key?(stanza) }
raise "missing: #{missing}" unless missing.empty?
raise "the description is too long, or begins with an article" if Formula::STANZAS[:desc].match?(/\A(An?|The) |.{81}|\.\z/)

pages = formula.man1.glob("*.1").map { |page| page.basename(".1").to_s }
commands = `#{DRYPOINT} --help`[/^Commands:\n(.*?)^Options:/m, 1].scan(/^  ([a-z]+)/).flatten - ["help"]
wanted = ["drypoint", *commands.map { |command| "drypoint-#{command}" }]
raise "pages: #{pages.sort}, wanted: #{wanted.sort}" unless pages.sort == wanted.sort
raise "an empty page" if formula.man1.glob("*.1").any? { |page| page.read.scan(/^\.TH /).size != 1 || page.size < 150 }
raise "no extension for Inkscape" unless (formula.share/"drypoint/inkscape/drypoint/drypoint.inx").exist?

formula.caveats
puts "#{pages.size} pages"
